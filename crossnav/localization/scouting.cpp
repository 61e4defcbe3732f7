// SPDX-License-Identifier: MIT
#include "crossnav/localization/scouting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "crossnav/planner/ground_search.h"

namespace crossnav::localization {
namespace {

using geometry::VoxelKey;

constexpr double kRayReach_m = 6;  // chosen: about the reach of a scan
constexpr int kAzimuths = 24;      // chosen: every 15 degrees
constexpr std::array<double, 4> kElevations_deg = {-35, -15, 0,
                                                   20};  // chosen: inside the field of view
constexpr double kDiffers_m = 0.4;                       // chosen: more than voxels and noise
constexpr double kLeastDifference = 0.03;                // chosen: three rays; fewer are chance
constexpr double kReach_m = 25;                          // chosen: path cost of the planner
constexpr int kApart_vox = 4;                            // chosen: spacing of outlooks
constexpr double kFixed_m = 2;  // chosen: cost of any walk, besides its length
constexpr double kSilent = -1;

/// Distance to the first surface; kRayReach_m without a surface, kSilent if unknown space comes
/// first.
double CastRay(const DenseMap& map, const Vector3d& p_map, const Vector3d& direction) {
  const double step_m = map.voxel_m / 2;
  for (double s = 0.2; s < kRayReach_m; s += step_m) {
    const Content content = map.ContentAt(geometry::KeyOf(p_map + s * direction, map.voxel_m));
    if (content == Content::kSurface) return s;
    if (content == Content::kUnknown) return kSilent;
  }
  return kRayReach_m;
}

using Panorama = std::array<double, kAzimuths * kElevations_deg.size()>;

Panorama Predict(const DenseMap& map, const Vector3d& eye_map, double yaw_rad) {
  Panorama view{};
  std::size_t i = 0;
  for (int a = 0; a < kAzimuths; ++a)
    for (const double elevation_deg : kElevations_deg) {
      const double azimuth = yaw_rad + DegToRad(360.0 * a / kAzimuths);
      const double up = DegToRad(elevation_deg);
      view[i++] = CastRay(
          map, eye_map,
          {std::cos(azimuth) * std::cos(up), std::sin(azimuth) * std::cos(up), std::sin(up)});
    }
  return view;
}

double DifferenceOf(const Panorama& a, const Panorama& b) {
  int differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool is_silent = a[i] == kSilent || b[i] == kSilent;
    differing += !is_silent && std::abs(a[i] - b[i]) > kDiffers_m ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(a.size());
}

/// Mean difference between the best hypothesis's prediction and the other predictions.
double DifferenceAt(const DenseMap& map, const std::vector<Hypothesis>& hypotheses, int others,
                    const Vector3d& eye_odom) {
  const auto predict = [&](const Hypothesis& h) {
    return Predict(map, h.T_map_odom * eye_odom, YawOf(h.T_map_odom));
  };
  const Panorama best = predict(hypotheses.front());
  double sum = 0;
  for (int k = 1; k <= others; ++k)
    sum += DifferenceOf(best, predict(hypotheses[static_cast<std::size_t>(k)]));
  return others > 0 ? sum / others : 0;
}

}  // namespace

Outlook FindOutlook(const DenseMap& map, const planner::GroundMap& ground,
                    const std::vector<Hypothesis>& hypotheses, int others,
                    const Vector3d& p_foot_odom, double camera_height_m) {
  const Pose& T_map_odom = hypotheses.front().T_map_odom;
  const auto start = ground.StandingAt(T_map_odom * p_foot_odom);
  if (!start) return {};
  const planner::PlannerConfig planner;
  planner::GroundSearch search(ground, planner, *start);
  const Pose T_odom_map = T_map_odom.inverse();
  Outlook best;
  double best_worth = 0;
  VoxelKey best_key;
  while (const auto key = search.Next()) {
    const double length_m = search.cost() * map.voxel_m;
    if (length_m > kReach_m || best_worth > 1 / (kFixed_m + length_m)) break;
    if (key->x % kApart_vox != 0 || key->y % kApart_vox != 0) continue;
    const Vector3d eye_map =
        geometry::CenterOf(*key, map.voxel_m) + Vector3d(0, 0, camera_height_m - map.voxel_m / 2);
    const double difference = DifferenceAt(map, hypotheses, others, T_odom_map * eye_map);
    const double worth = difference / (kFixed_m + length_m);
    if (difference < kLeastDifference || worth <= best_worth) continue;
    best_worth = worth, best_key = *key, best.difference = difference;
  }
  if (best_worth > 0) best.path_map = search.PathTo(best_key);
  return best;
}

}  // namespace crossnav::localization
