// SPDX-License-Identifier: MIT
// The geometric map, literally: sets of voxels in ordered containers, one pixel, one voxel at a
// time, written from the method alone. The oracle of the tests; far too slow for anything else.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <unordered_set>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/geometry/map_config.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry::testing {

using KeySet = std::unordered_set<VoxelKey, VoxelKeyHash>;

struct FrameSets {
  KeySet hit;
  KeySet free;  ///< passed by some ray; may overlap `hit`
};

/// Amanatides and Woo, per pixel. Crossing times from the faces, ties in the order x, y, z.
template <class F>
void WalkPixel(const double start[3], const double end[3], F&& visit) {
  int cell[3], last[3];
  for (int a = 0; a < 3; ++a) {
    cell[a] = static_cast<int>(std::floor(start[a]));
    last[a] = static_cast<int>(std::floor(end[a]));
  }
  while (cell[0] != last[0] || cell[1] != last[1] || cell[2] != last[2]) {
    visit(VoxelKey{cell[0], cell[1], cell[2]});
    int next = -1;
    double first = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
      if (cell[a] == last[a]) continue;
      const double face = last[a] > cell[a] ? cell[a] + 1 : cell[a];
      const double time = (face - start[a]) * (1 / (end[a] - start[a]));
      if (next < 0 || time < first) {
        next = a;
        first = time;
      }
    }
    cell[next] += last[next] > cell[next] ? 1 : -1;
  }
}

/// Calls hit(key) for every end voxel and pass(key) for every voxel before one, pixel by pixel.
template <class Hit, class Pass>
void VisitLiterally(const MapConfig& config, const DepthImage& depth, const CameraIntrinsics& K,
                    const Pose& T, Hit&& hit, Pass&& pass) {
  const double s = config.voxel_m;
  const double start[3] = {T(0, 3) / s, T(1, 3) / s, T(2, 3) / s};
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      double z = depth.At(u, v);
      if (!std::isfinite(z) || z <= 0 || z < config.depth_min_m) continue;
      const bool is_hit = z <= config.depth_max_m;
      if (!is_hit) z = config.depth_max_m;
      const double x = (u - K.cx) * z / K.fx, y = (v - K.cy) * z / K.fy;
      double end[3];
      for (int a = 0; a < 3; ++a) end[a] = (T(a, 0) * x + T(a, 1) * y + T(a, 2) * z + T(a, 3)) / s;
      WalkPixel(start, end, pass);
      if (is_hit)
        hit(VoxelKey{static_cast<int>(std::floor(end[0])), static_cast<int>(std::floor(end[1])),
                     static_cast<int>(std::floor(end[2]))});
    }
  }
}

inline FrameSets IntegrateLiterally(const MapConfig& config, const DepthImage& depth,
                                    const CameraIntrinsics& K, const Pose& T) {
  FrameSets sets;
  VisitLiterally(
      config, depth, K, T, [&](const VoxelKey& key) { sets.hit.insert(key); },
      [&](const VoxelKey& key) { sets.free.insert(key); });
  return sets;
}

/// map.clearing = never.
struct ReferenceEvidence {
  KeySet hit, free;

  void Add(const FrameSets& frame) {
    hit.insert(frame.hit.begin(), frame.hit.end());
    free.insert(frame.free.begin(), frame.free.end());
    for (const VoxelKey& key : hit) free.erase(key);
  }
};

/// All states, derived from the evidence alone.
inline std::map<VoxelKey, Voxel> ClassifyLiterally(const MapConfig& config,
                                                   const std::map<VoxelKey, StairMark>& surface,
                                                   const KeySet& free) {
  const double s = config.voxel_m, tolerance = 1e-6;
  const int depth = static_cast<int>(config.support_depth_m / s + tolerance);
  const auto is_confirmed = [](StairMark mark) {
    return mark == StairMark::kStair || mark == StairMark::kExpanded;
  };
  const auto is_inflated = [&](const VoxelKey& key, int support_z, bool is_on_stair) {
    const int r = static_cast<int>(config.inflation_m / s + tolerance);
    for (int dx = -r; dx <= r; ++dx)
      for (int dy = -r; dy <= r; ++dy) {
        if (std::hypot(dx * s, dy * s) > config.inflation_m + tolerance) continue;
        for (int z = support_z + 1; (z - support_z) * s <= config.agent_height_m + tolerance; ++z) {
          if ((z - support_z) * s <= config.max_climb_m + tolerance) continue;
          const auto it = surface.find({key.x + dx, key.y + dy, z});
          if (it == surface.end()) continue;
          if (!(is_on_stair && is_confirmed(it->second))) return true;
        }
      }
    return false;
  };
  std::map<VoxelKey, Voxel> out;
  for (const auto& [key, mark] : surface) {
    static constexpr VoxelState kOf[] = {VoxelState::kOccupied, VoxelState::kStair,
                                         VoxelState::kStairExpanded, VoxelState::kFakeStair};
    Voxel voxel{kOf[static_cast<int>(mark)], false};
    if (mark != StairMark::kNone) voxel.is_inflated = is_inflated(key, key.z, is_confirmed(mark));
    out[key] = voxel;
  }
  for (const VoxelKey& key : free) {
    if (surface.count(key) != 0) continue;
    Voxel voxel{VoxelState::kTraversableFake, false};
    for (int k = 1; k <= depth; ++k) {
      const auto it = surface.find({key.x, key.y, key.z - k});
      if (it == surface.end()) continue;
      const bool is_on_stair = is_confirmed(it->second);
      voxel.state = is_on_stair ? VoxelState::kTraversableStair : VoxelState::kTraversable;
      voxel.is_inflated = is_inflated(key, key.z - k, is_on_stair);
      break;
    }
    out[key] = voxel;
  }
  return out;
}

/// Every observed voxel of `map`.
inline std::map<VoxelKey, Voxel> StatesOf(const VoxelMap& map) {
  std::map<VoxelKey, Voxel> out;
  map.ForEach([&](const VoxelKey& key, const Voxel& voxel) { out[key] = voxel; });
  return out;
}

/// Where two maps differ, for messages; empty if they are equal.
inline std::string Differences(const std::map<VoxelKey, Voxel>& a,
                               const std::map<VoxelKey, Voxel>& b) {
  std::string out;
  int count = 0;
  const auto compare = [&](const VoxelKey& key, const Voxel& left, const Voxel& right) {
    if (left == right || ++count > 5) return;
    out += " (" + std::to_string(key.x) + "," + std::to_string(key.y) + "," +
           std::to_string(key.z) + "): " + std::string(FactsOf(left.state).name) +
           (left.is_inflated ? "+" : "") + " / " + std::string(FactsOf(right.state).name) +
           (right.is_inflated ? "+" : "");
  };
  for (const auto& [key, voxel] : a) compare(key, voxel, b.count(key) ? b.at(key) : Voxel{});
  for (const auto& [key, voxel] : b)
    if (a.count(key) == 0) compare(key, Voxel{}, voxel);
  return count == 0 ? "" : std::to_string(count) + " differ:" + out;
}

}  // namespace crossnav::geometry::testing
