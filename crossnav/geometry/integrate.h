// SPDX-License-Identifier: MIT
// From a depth image to the frame masks: end voxels, and the voxels that rays pass before them. Two
// algorithms find the passed voxels, with the same result under `map.rays = exact`: ray casting
// walks every pixel's ray; projection tests every voxel in view against the rays, once per frame
// instead of once per pixel. Internal to the map.
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

/// A box of whole blocks, or more, that holds the camera's voxel and all ends.
struct KeyBounds {
  VoxelKey lo, hi;
  void Add(const VoxelKey& key) {
    lo = {std::min(lo.x, key.x), std::min(lo.y, key.y), std::min(lo.z, key.z)};
    hi = {std::max(hi.x, key.x), std::max(hi.y, key.y), std::max(hi.z, key.z)};
  }
};

/// End voxels of pixels of row v, and their reach (see DepthView). Pixels settled by the literal
/// formula extend `bounds`, even beyond depth_max.
void ComputeEnds(const DepthFrame& frame, const MapConfig& config, int v, RowSpan pixels,
                 RowEnds* ends, float* reach_m, KeyBounds* bounds);

/// Marks the end voxels of the frame and lists them in map.pixels.
KeyBounds CollectEnds(MapData& map, const DepthFrame& frame);

/// Marks passed voxels, ray by ray. Cost: pixels x voxels along a ray.
void CollectFreeByWalking(MapData& map, const DepthFrame& frame);

/// The same, voxel by voxel; needs map.view of this frame. `fast`: a voxel that few rays pass may
/// be missed. Voxels with settled evidence are skipped.
void CollectFreeByProjection(MapData& map, const DepthFrame& frame, const KeyBounds& bounds);

/// True where projecting voxels costs less than walking rays: almost always, but for small images.
bool IsProjectionCheaper(const MapData& map, const DepthFrame& frame);

}  // namespace crossnav::geometry
