// SPDX-License-Identifier: MIT
// From the visible triangle of each pixel to its depth, instance and colour. Several pixels at a
// time, on every processor the same (as raster_lanes.h). Internal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/sim/render/raster_lanes.h"
#include "crossnav/sim/render/shade_lanes.h"
#include "crossnav/sim/scene/frame.h"

namespace crossnav::sim {

/// Rays through the middle of pixels, world frame; z of the direction in the camera frame is 1, so
/// that the ray parameter is planar depth. A ray is the sum of what its column and its row say.
struct PixelRays {
  PixelRays(const CameraIntrinsics& K, const Pose& T_world_camera);

  std::array<std::vector<float>, 3> across, down;  ///< by axis; columns beyond the picture, too
};

/// Writes depth and instance of the pixels that show a triangle.
void ResolveGeometry(const Canvas& canvas, const PixelRays& rays, Frame& frame);

/// Likewise their colours.
void ResolveColour(const Canvas& canvas, const PixelRays& rays, const Skins& skins, RgbImage& rgb);

}  // namespace crossnav::sim
