// SPDX-License-Identifier: MIT
// Pictures for people: PNG files, colours for depth and instances, a floor seen from above.
#pragma once

#include <filesystem>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// Writes atomically: a reader never sees half a file.
Result<void> WritePng(const RgbImage& image, const std::filesystem::path& file);

/// Near = warm and bright, `max_m` = dark blue, no surface = black.
RgbImage ColourDepth(const DepthImage& depth_m, double max_m = 10);
/// One stable colour per instance id; 0 = black.
RgbImage ColourInstances(const InstanceImage& instance);

/// Where a top-down picture lies in the world: pixel (u, v) is at
/// (max_x - (v + 0.5) / px_per_m, max_y - (u + 0.5) / px_per_m), so that world +x is up.
struct TopDown {
  RgbImage image;
  double max_x_m = 0, max_y_m = 0, px_per_m = 0;

  double U(const Vector3d& p_world) const { return (max_y_m - p_world.y()) * px_per_m - 0.5; }
  double V(const Vector3d& p_world) const { return (max_x_m - p_world.x()) * px_per_m - 0.5; }
};

/// Mixed into the colour of walkable ground seen from above.
inline constexpr Rgb8 kWalkableTint{60, 190, 90};

/// Floor `floor` of the navmesh from above, cut 2 m over its ground so that furniture shows and the
/// ceiling does not; walkable ground has kWalkableTint. `floor` must exist; at most 4096 px a side.
TopDown RenderTopDown(const Scene& scene, const RayCaster& caster, const NavMesh& navmesh,
                      int floor, double px_per_m);

}  // namespace crossnav::sim
