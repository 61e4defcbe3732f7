// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

/// One image row of voxel coordinates: q = start + depth x (base + step x u), per axis.
struct RowRays {
  std::array<double, 3> start{}, base{}, step{};
};

struct RowKeys {
  std::array<std::vector<std::int32_t>, 3> key;
  std::vector<std::uint8_t> is_doubtful;  ///< a face is nearer than rounding may decide
};

// chosen: rounding errors of the row formula stay below 1e-12 voxels for maps of a kilometre.
constexpr double kDoubt_vox = 1e-9;

void KeysOfRow(const float* reach_m, int width, const RowRays& rays, RowKeys* out) {
  std::uint8_t* doubtful = out->is_doubtful.data();
  for (int u = 0; u < width; ++u) doubtful[u] = 0;
  for (int a = 0; a < 3; ++a) {
    std::int32_t* key = out->key[a].data();
    const double start = rays.start[a], base = rays.base[a], step = rays.step[a];
    for (int u = 0; u < width; ++u) {
      const double q = start + reach_m[u] * (base + step * u);
      std::int32_t k = static_cast<std::int32_t>(q);
      k -= q < k ? 1 : 0;
      const double fraction = q - k;
      key[u] = k;
      doubtful[u] |= static_cast<std::uint8_t>(fraction < kDoubt_vox) |
                     static_cast<std::uint8_t>(fraction > 1 - kDoubt_vox);
    }
  }
}

RowRays RaysOfRow(const DepthFrame& frame, double voxel_m, int v) {
  const CameraIntrinsics& K = frame.camera;
  const auto& T = frame.T_world_camera.matrix();
  RowRays rays;
  for (int a = 0; a < 3; ++a) {
    rays.start[a] = T(a, 3) / voxel_m;
    rays.step[a] = T(a, 0) / K.fx / voxel_m;
    rays.base[a] = (T(a, 1) * (v - K.cy) / K.fy + T(a, 2)) / voxel_m - K.cx * rays.step[a];
  }
  return rays;
}

}  // namespace

KeyBounds CollectEnds(MapData& map, const DepthFrame& frame) {
  const MapConfig& config = map.config;
  const int width = frame.depth_m.width, height = frame.depth_m.height;
  const VoxelKey camera_key = KeyOfVoxelPoint(frame.T_world_camera.translation() / config.voxel_m);
  KeyBounds bounds{camera_key, camera_key};
  FrameMarker marker(map);
  RowKeys keys;
  for (auto& key : keys.key) key.resize(width);
  keys.is_doubtful.resize(width);
  map.pixels.clear();
  map.pixels.reserve(frame.depth_m.data.size());
  VoxelKey last;
  bool is_last_kept = false, has_last = false;
  for (int v = 0; v < height; ++v) {
    const float* depth_m = &frame.depth_m.data[static_cast<std::size_t>(v) * width];
    const float* reach_m = map.view.Row(v);
    KeysOfRow(reach_m, width, RaysOfRow(frame, config.voxel_m, v), &keys);
    for (int u = 0; u < width; ++u) {
      if (reach_m[u] == 0) continue;
      const bool is_hit = !(depth_m[u] > config.depth_max_m);
      VoxelKey key{keys.key[0][u], keys.key[1][u], keys.key[2][u]};
      if (keys.is_doubtful[u] != 0 || !is_hit) {
        const double depth = is_hit ? depth_m[u] : config.depth_max_m;
        key = KeyOfVoxelPoint(
            BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v, depth, config.voxel_m));
      }
      if (!is_hit) {
        bounds.Add(key);
        continue;
      }
      if (!has_last || key != last) {
        bounds.Add(key);
        bool is_new = false;
        is_last_kept = marker.MarkHit(key, &is_new);
        last = key;
        has_last = true;
      }
      if (is_last_kept) map.pixels.push_back({v * width + u, key});
    }
  }
  return bounds;
}

}  // namespace crossnav::geometry
