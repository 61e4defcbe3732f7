// SPDX-License-Identifier: MIT
// Pictures of a scene, triangle by triangle: the first hit of a ray through the middle of each
// pixel, in a third of the time of ray casting (docs/architecture.md, "Pictures"). Deterministic,
// with the same bytes on every set of instructions. Rendering is const and may be called from
// several threads.
#pragma once

#include <memory>

#include "crossnav/core/camera.h"
#include "crossnav/core/pose.h"
#include "crossnav/sim/scene/frame.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

class Rasterizer {
 public:
  /// Keeps a reference to `scene`, which must outlive it.
  explicit Rasterizer(const Scene& scene);
  ~Rasterizer();
  Rasterizer(Rasterizer&&) noexcept;

  Frame Render(const CameraIntrinsics& camera, const Pose& T_world_camera, Channels channels) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::sim
