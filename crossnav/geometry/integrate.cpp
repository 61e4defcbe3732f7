// SPDX-License-Identifier: MIT
#include "crossnav/geometry/integrate.h"

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {

void CollectFreeByWalking(MapData& map, const DepthFrame& frame) {
  const MapConfig& config = map.config;
  const Vector3d start = frame.T_world_camera.translation() / config.voxel_m;
  FrameMarker passed(map);
  for (int v = 0; v < frame.depth_m.height; ++v) {
    for (int u = 0; u < frame.depth_m.width; ++u) {
      const DepthReach reach =
          ReachOf(frame.depth_m.At(u, v), config.depth_min_m, config.depth_max_m);
      if (reach.depth_m <= 0) continue;
      const Vector3d end = BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v,
                                               reach.depth_m, config.voxel_m);
      WalkRay(start, end, [&](const VoxelKey& key) {
        passed.MarkFree(key);
        return true;
      });
    }
  }
}

bool IsProjectionCheaper(const MapData& map, const DepthFrame& frame) {
  // Voxels per pixel against ray steps per pixel, of every 251st pixel; a voxel asked costs about
  // eight steps. chosen: measured once, the decision is not sensitive.
  constexpr std::size_t kStride = 251;
  constexpr double kVoxelCost = 8, kStepsPerVoxel = 1.5;
  const double pixel = 1 / (frame.camera.fx * frame.camera.fy);
  double voxels = 0, steps = 0;
  for (std::size_t i = 0; i < frame.depth_m.data.size(); i += kStride) {
    const double reach =
        ReachOf(frame.depth_m.data[i], map.config.depth_min_m, map.config.depth_max_m).depth_m /
        map.config.voxel_m;
    voxels += reach * reach * reach * pixel / 3;
    steps += reach * kStepsPerVoxel;
  }
  return voxels * kVoxelCost < steps;
}

}  // namespace crossnav::geometry
