// SPDX-License-Identifier: MIT
#include "crossnav/localization/local_scan.h"

#include <algorithm>
#include <cmath>

namespace crossnav::localization {
namespace {

constexpr int kPointsAcross = 64;  // chosen: pixels of a row that become points
constexpr int kBeamsAcross = 10;   // chosen: pixels of a row that become beams

/// Calls visit(point) for pixels on a grid of `across` columns that have depth.
template <class F>
void ForEachPixel(const Observation& obs, int across, double reach_m, F&& visit) {
  const int step = std::max(1, obs.depth_m.width / across);
  for (int v = step / 2; v < obs.depth_m.height; v += step)
    for (int u = step / 2; u < obs.depth_m.width; u += step) {
      const float depth_m = obs.depth_m.At(u, v);
      if (!std::isfinite(depth_m) || depth_m <= 0 || depth_m > reach_m) continue;
      const Vector3d p = obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m);
      visit(Vector3f(p.cast<float>()));
    }
}

}  // namespace

void LocalScan::Add(const Observation& obs) {
  const std::size_t before = beams_.size();
  const Vector3f p_eye = obs.T_world_camera.translation().cast<float>();
  ForEachPixel(obs, kPointsAcross, reach_m_, [&](const Vector3f& p) {
    if (taken_.insert(geometry::KeyOf(p.cast<double>(), voxel_m_)).second)
      points_odom_.push_back(p);
  });
  ForEachPixel(obs, kBeamsAcross, reach_m_, [&](const Vector3f& p) {
    beams_.push_back({p_eye, p});
  });
  if (beams_.size() > before) ++frames_;
}

std::vector<Vector3f> ChoosePoints(const std::vector<Vector3f>& points, const PointChoice& choice) {
  std::unordered_set<geometry::VoxelKey, geometry::VoxelKeyHash> taken;
  std::vector<Vector3f> spread;
  for (const Vector3f& p : points) {
    const Vector3d d = p.cast<double>() - choice.p_foot_odom;
    if (d.z() < choice.low_m || d.z() > choice.high_m) continue;
    if (std::hypot(d.x(), d.y()) > choice.reach_m) continue;
    if (taken.insert(geometry::KeyOf(p.cast<double>(), choice.apart_m)).second) spread.push_back(p);
  }
  const auto count = static_cast<std::size_t>(choice.count);
  if (spread.size() <= count) return spread;
  std::vector<Vector3f> chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(spread[i * spread.size() / count]);
  return chosen;
}

}  // namespace crossnav::localization
