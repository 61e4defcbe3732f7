// SPDX-License-Identifier: MIT
#include "crossnav/policy/view_evidence.h"

#include <algorithm>
#include <cmath>

#include "crossnav/policy/goal_length.h"

namespace crossnav::policy {

double LogOddsOf(double score) {
  constexpr double kLeast = 0.01;  // chosen: no score is certain
  const double p = std::clamp(score, kLeast, 1 - kLeast);
  return std::log(p / (1 - p));
}

ViewSummary SummaryOf(const std::vector<ViewScore>& views, std::string_view goal, double discount) {
  double best = 0, sum = 0, length_m = 0;
  for (const ViewScore& view : views) {
    best = std::max(best, view.Mean());
    sum += view.Mean();
    length_m = std::max(length_m, view.Length_m());
  }
  ViewSummary summary;
  summary.views = static_cast<int>(views.size());
  if (length_m > 0) summary.shortness = ShortnessOf(goal, length_m);
  summary.best_log_odds = LogOddsOf(best);
  if (views.size() < 2) return summary;
  summary.mean = (sum - best) / static_cast<double>(views.size() - 1);
  double next = 1;
  for (std::size_t i = 1; i < views.size(); ++i, next *= discount) summary.others += next;
  return summary;
}

double ProbabilityOf(const ViewSummary& views, const EvidenceConfig& config) {
  if (views.views == 0) return 0.5;
  const double of_another = config.missed + (config.found - config.missed) * views.mean;
  const double log_odds = config.offset + config.slope * views.best_log_odds +
                          views.others * of_another + views.shortness * config.too_short;
  return 1 / (1 + std::exp(-log_odds));
}

Sight SightOf(const std::vector<geometry::VoxelKey>& voxels, const Observation& obs,
              double voxel_m) {
  constexpr double kAsFar_m = 0.25;  // chosen: a voxel and the error of the depth
  Sight sight;
  if (voxels.empty()) return sight;
  const Pose T_camera_world = obs.T_world_camera.inverse();
  const double share = 1.0 / static_cast<double>(voxels.size());
  Vector3d p_mean = Vector3d::Zero();
  for (const geometry::VoxelKey& key : voxels) {
    const Vector3d p = T_camera_world * geometry::CenterOf(key, voxel_m);
    p_mean += share * p;
    if (p.z() <= 0) continue;
    const double u = std::round(obs.camera.fx * p.x() / p.z() + obs.camera.cx);
    const double v = std::round(obs.camera.fy * p.y() / p.z() + obs.camera.cy);
    if (!(u >= 0 && v >= 0 && u < obs.depth_m.width && v < obs.depth_m.height)) continue;
    sight.framed += share;
    const double depth_m = obs.depth_m.At(static_cast<int>(u), static_cast<int>(v));
    if (std::abs(depth_m - p.z()) <= kAsFar_m) sight.shown += share;
  }
  sight.range_m = p_mean.norm();
  return sight;
}

bool IsPlain(const Sight& sight) {
  constexpr double kLeast_m = 0.8;      // chosen: nearer things fill the image
  constexpr double kMost_m = 4;         // chosen: detectors miss small things beyond
  constexpr double kLeastFramed = 0.8;  // chosen: less of it may not be recognised
  constexpr double kLeastShown = 0.25;  // chosen: of the sides that were seen, some are behind it
  return sight.range_m >= kLeast_m && sight.range_m <= kMost_m && sight.framed >= kLeastFramed &&
         sight.shown >= kLeastShown;
}

}  // namespace crossnav::policy
