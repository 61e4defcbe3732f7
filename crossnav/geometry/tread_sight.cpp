// SPDX-License-Identifier: MIT
#include "crossnav/geometry/tread_sight.h"

namespace crossnav::geometry {
namespace {

constexpr double kSteepness = 0.36;  // chosen: 20 degrees; the agent looks down at the next treads
                                     // by 30 degrees and more

}  // namespace

void SpareTreads(MapData& map, const DepthFrame& frame) {
  const Vector3d& p_camera_world = frame.T_world_camera.translation();
  for (GridEntry* entry : map.frame) {
    VoxelBlock& block = entry->block;
    const BlockMask is_stair = block.stair_low & ~block.stair_high;
    ForEachCell(block.hit & block.frame_free & ~block.frame_hit & is_stair, [&](int cell) {
      const Vector3d up =
          p_camera_world - CenterOf(KeyInBlock(entry->key, cell), map.config.voxel_m);
      if (up.z() < kSteepness * up.head<2>().norm()) block.frame_free.Reset(cell);
    });
  }
}

}  // namespace crossnav::geometry
