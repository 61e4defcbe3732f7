// SPDX-License-Identifier: MIT
#include "crossnav/geometry/integrate.h"

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {

void CollectByWalking(MapData& map, const DepthFrame& frame) {
  const MapConfig& config = map.config;
  const bool is_fast = config.rays == "fast";
  const Vector3d start = frame.T_world_camera.translation() / config.voxel_m;
  FrameMarker ends(map), passed(map);
  map.pixels.clear();
  for (int v = 0; v < frame.depth_m.height; ++v) {
    for (int u = 0; u < frame.depth_m.width; ++u) {
      const DepthReach reach =
          ReachOf(frame.depth_m.At(u, v), config.depth_min_m, config.depth_max_m);
      if (reach.depth_m <= 0) continue;
      const Vector3d end = BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v,
                                               reach.depth_m, config.voxel_m);
      bool is_new = false;
      if (reach.is_hit) {
        const VoxelKey key = KeyOfVoxelPoint(end);
        if (ends.MarkHit(key, &is_new)) map.pixels.push_back({v * frame.depth_m.width + u, key});
      }
      if (is_fast && !is_new && (u % 4 != 0 || v % 4 != 0)) continue;
      WalkRay(start, end, [&](const VoxelKey& key) {
        passed.MarkFree(key);
        return true;
      });
    }
  }
}

}  // namespace crossnav::geometry
