// SPDX-License-Identifier: MIT
// Views of a scene: along one ray (Embree), and by a camera (rasterizer.h). Deterministic. Both are
// const and may be called from several threads.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "crossnav/core/camera.h"
#include "crossnav/core/pose.h"
#include "crossnav/sim/scene/frame.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// AVX2 on newer processors, too: whether a ray meets the edge of a surface depends on the
/// instruction set, and an episode must be the same on every machine.
inline constexpr const char* kInstructions = "avx2";

struct RayHit {
  double distance_m = 0;
  int instance = 0;
  Vector3d p_world = Vector3d::Zero();
  std::uint32_t triangle = 0;
  Rgb8 colour;  ///< as Render would show it
};

class RayCaster {
 private:
  struct Impl;

 public:
  /// Keeps a reference to `scene`, which must outlive it. `instructions`: the newest that Embree
  /// may use, e.g. avx; for tests.
  explicit RayCaster(const Scene& scene, const std::string& instructions = kInstructions);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;

  Frame Render(const CameraIntrinsics& camera, const Pose& T_world_camera,
               Channels channels = Channels::kAll) const;

  /// First surface along the ray, within `max_m`; of several in one plane, the first in the mesh.
  std::optional<RayHit> Cast(const Vector3d& p_world, const Vector3d& direction,
                             double max_m) const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::sim
