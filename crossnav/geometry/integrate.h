// SPDX-License-Identifier: MIT
// From a depth image to the frame masks: end voxels, and the voxels before them. Internal.
#pragma once

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/geometry/map_data.h"

namespace crossnav::geometry {

struct DepthFrame {
  const DepthImage& depth_m;
  const CameraIntrinsics& camera;
  const Pose& T_world_camera;
};

/// Fills map.pixels and the frame masks by walking pixels' rays (map.rays).
void CollectByWalking(MapData& map, const DepthFrame& frame);

}  // namespace crossnav::geometry
