// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/end_rows.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

RowRays RaysOfRow(const DepthFrame& frame, const MapConfig& config, int v) {
  const double voxel_m = config.voxel_m;
  const CameraIntrinsics& K = frame.camera;
  const auto& T = frame.T_world_camera.matrix();
  RowRays rays;
  rays.depth_min_m = config.depth_min_m;
  rays.depth_max_m = config.depth_max_m;
  for (int a = 0; a < 3; ++a) {
    rays.start[a] = T(a, 3) / voxel_m;
    rays.step[a] = T(a, 0) / K.fx / voxel_m;
    rays.base[a] = (T(a, 1) * (v - K.cy) / K.fy + T(a, 2)) / voxel_m - K.cx * rays.step[a];
  }
  return rays;
}

/// Settles the pixels that ComputeRow left open by the literal formula. Rays beyond depth_max
/// extend `bounds` up to it: their ends form a line, so that its two ends bound a row.
void SettleSpecial(const DepthFrame& frame, const MapConfig& config, int v, RowEnds* ends,
                   KeyBounds* bounds) {
  const auto key_at = [&](int u, double depth_m) {
    return KeyOfVoxelPoint(
        BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v, depth_m, config.voxel_m));
  };
  for (int i = 0; i < ends->special_count; ++i) {
    const int u = ends->special[i];
    const VoxelKey key = key_at(u, frame.depth_m.At(u, v));
    ends->x[u] = key.x;
    ends->y[u] = key.y;
    ends->z[u] = key.z;
  }
  if (ends->last_beyond < 0) return;
  bounds->Add(key_at(ends->first_beyond, config.depth_max_m));
  bounds->Add(key_at(ends->last_beyond, config.depth_max_m));
}

/// Marks each run of equal voxels once and lists it; where the map is clipped, adds to `bounds`
/// only.
void MarkRuns(MapData& map, const RowEnds& ends, int v, FrameMarker& marker, KeyBounds* bounds) {
  const int width = map.view.width();
  for (int i = 0; i < ends.start_count; ++i) {
    const int u = ends.starts[i];
    const VoxelKey key{ends.x[u], ends.y[u], ends.z[u]};
    if (key.x == kNoEnd) continue;
    if (!marker.MarkHit(key)) {
      bounds->Add(key);
      continue;
    }
    const int end = i + 1 < ends.start_count ? ends.starts[i + 1] : width;
    map.ends.runs()->push_back({v * width + u, end - u, key});
  }
}

}  // namespace

void ComputeEnds(const DepthFrame& frame, const MapConfig& config, int v, RowSpan pixels,
                 RowEnds* ends, float* reach_m, KeyBounds* bounds) {
  const float* depth_m = &frame.depth_m.At(0, v);
  ComputeRow(depth_m, pixels, RaysOfRow(frame, config, v), ends, reach_m);
  SettleSpecial(frame, config, v, ends, bounds);
}

KeyBounds CollectEnds(MapData& map, const DepthFrame& frame) {
  const int width = frame.depth_m.width, height = frame.depth_m.height;
  const VoxelKey camera_key =
      KeyOfVoxelPoint(frame.T_world_camera.translation() / map.config.voxel_m);
  KeyBounds bounds{camera_key, camera_key};
  FrameMarker marker(map);
  map.row_ends.Resize(width);
  map.ends.Clear();
  for (int v = 0; v < height; ++v) {
    ComputeEnds(frame, map.config, v, {0, width}, &map.row_ends, map.view.Row(v), &bounds);
    FindRuns(width, &map.row_ends);
    MarkRuns(map, map.row_ends, v, marker, &bounds);
  }
  for (const GridEntry* entry : map.frame) {
    bounds.Add(KeyInBlock(entry->key, 0));
    bounds.Add(KeyInBlock(entry->key, kBlockVoxels - 1));
  }
  map.view.Fill();
  return bounds;
}

}  // namespace crossnav::geometry
