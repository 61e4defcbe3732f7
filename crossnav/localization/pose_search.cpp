// SPDX-License-Identifier: MIT
#include "crossnav/localization/pose_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "crossnav/core/cells.h"

namespace crossnav::localization {
namespace {

using geometry::VoxelKey;

constexpr int kHeadingSector_deg = 15;    // chosen: one hypothesis a sector and ...
constexpr double kNeighbourhood_m = 0.6;  // chosen: ... a square of this side

struct GridPose {
  int score = 0;
  int place = 0, heading = 0;
};

/// Orders poses of the grid by score, then by index.
bool IsBetter(const GridPose& a, const GridPose& b) {
  return std::tie(b.score, a.place, a.heading) < std::tie(a.score, b.place, b.heading);
}

/// Offsets of the points in the dense array, for a foot in the middle of a voxel's floor.
std::vector<std::int32_t> OffsetsOf(const DenseMap& map, const std::vector<Vector3f>& points_foot,
                                    double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad), v = 1 / map.voxel_m;
  std::vector<std::int32_t> offsets;
  offsets.reserve(points_foot.size());
  for (const Vector3f& p : points_foot) {
    const int x = static_cast<int>(std::floor((c * p.x() - s * p.y()) * v + 0.5));
    const int y = static_cast<int>(std::floor((s * p.x() + c * p.y()) * v + 0.5));
    const int z = static_cast<int>(std::floor(p.z() * v));
    offsets.push_back((z * map.ny + y) * map.nx + x);
  }
  return offsets;
}

/// Keeps the best pose of each neighbourhood and sector.
class BestOfEach {
 public:
  BestOfEach(const std::vector<VoxelKey>& places, double voxel_m, double yaw_step_deg)
      : places_(places),
        side_(std::max(1, CellsNearest(kNeighbourhood_m, voxel_m))),
        headings_(std::max(1, static_cast<int>(kHeadingSector_deg / yaw_step_deg))) {}

  void Offer(const GridPose& pose) {
    const VoxelKey& p = places_[static_cast<std::size_t>(pose.place)];
    const auto floor_div = [&](int a) { return (a >= 0 ? a : a - side_ + 1) / side_; };
    const std::tuple cell{floor_div(p.x), floor_div(p.y), floor_div(p.z), pose.heading / headings_};
    const auto [it, is_new] = best_.try_emplace(cell, pose);
    if (!is_new && IsBetter(pose, it->second)) it->second = pose;
  }
  std::vector<GridPose> Take(int count) const {
    std::vector<GridPose> poses;
    for (const auto& [cell, pose] : best_) poses.push_back(pose);
    std::sort(poses.begin(), poses.end(), IsBetter);
    if (poses.size() > static_cast<std::size_t>(count))
      poses.resize(static_cast<std::size_t>(count));
    return poses;
  }

 private:
  const std::vector<VoxelKey>& places_;
  int side_, headings_;
  std::map<std::tuple<int, int, int, int>, GridPose> best_;
};

std::vector<GridPose> ScanGrid(const DenseMap& map, const std::vector<VoxelKey>& places,
                               const std::vector<Vector3f>& points_foot,
                               const LocalizeConfig& config) {
  BestOfEach best(places, map.voxel_m, config.yaw_step_deg);
  const int headings = CellsNearest(360, config.yaw_step_deg);
  std::vector<int> bar(static_cast<std::size_t>(config.hypotheses), 0);  // heap, worst first
  const std::size_t early = points_foot.size() / 4;
  for (int heading = 0; heading < headings; ++heading) {
    const auto offsets = OffsetsOf(map, points_foot, DegToRad(heading * config.yaw_step_deg));
    for (std::size_t place = 0; place < places.size(); ++place) {
      const std::uint8_t* at = map.score.data() + map.IndexOf(places[place]);
      int score = 0;
      std::size_t i = 0;
      for (; i < early; ++i) score += at[offsets[i]];
      // Early rejection: a quarter of the points scores far below the worst kept pose.
      if (4 * score < 0.7 * bar.front()) continue;
      for (; i < offsets.size(); ++i) score += at[offsets[i]];
      if (4 * score < 3 * bar.front()) continue;
      best.Offer({score, static_cast<int>(place), heading});
      if (score <= bar.front()) continue;
      std::pop_heap(bar.begin(), bar.end(), std::greater<>());
      bar.back() = score;
      std::push_heap(bar.begin(), bar.end(), std::greater<>());
    }
  }
  return best.Take(config.hypotheses);
}

}  // namespace

std::vector<VoxelKey> StandingPlaces(const geometry::VoxelMap& map,
                                     const planner::GroundMap& ground, double step_m) {
  const int step = std::max(1, CellsNearest(step_m, map.config().voxel_m));
  const auto square = [&](int a) { return a >= 0 ? a / step : (a - step + 1) / step; };
  std::map<std::tuple<int, int, int>, VoxelKey> chosen;
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    if (voxel.state == geometry::VoxelState::kUnknown || !ground.IsStanding(key)) return;
    const auto [it, is_new] = chosen.try_emplace({square(key.x), square(key.y), key.z}, key);
    if (!is_new && key < it->second) it->second = key;
  });
  std::vector<VoxelKey> places;
  for (const auto& [cell, key] : chosen) places.push_back(key);
  return places;
}

std::vector<Hypothesis> SearchPoses(const DenseMap& map, const std::vector<VoxelKey>& places,
                                    const LocalScan& scan, const Vector3d& p_foot_odom,
                                    const LocalizeConfig& config) {
  PointChoice choice;
  choice.p_foot_odom = p_foot_odom;
  choice.reach_m = config.reach_m;
  choice.count = config.search_points;
  std::vector<Vector3f> points_foot = ChoosePoints(scan.points_odom(), choice);
  for (Vector3f& p : points_foot) p -= p_foot_odom.cast<float>();
  // Every fourth point first, for the early rejection.
  std::vector<Vector3f> mixed;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = k; i < points_foot.size(); i += 4) mixed.push_back(points_foot[i]);
  const auto refine_points = RefinePoints(scan, p_foot_odom, config);
  std::vector<Hypothesis> hypotheses;
  for (const GridPose& pose : ScanGrid(map, places, mixed, config)) {
    const VoxelKey& key = places[static_cast<std::size_t>(pose.place)];
    const Vector3d p_map =
        geometry::MinCornerOf(key, map.voxel_m) + Vector3d(map.voxel_m / 2, map.voxel_m / 2, 0);
    Hypothesis h;
    h.T_map_odom = PlaceAt(p_map, DegToRad(pose.heading * config.yaw_step_deg), p_foot_odom);
    Refine(map, refine_points, p_foot_odom, config, h);
    hypotheses.push_back(h);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  return hypotheses;
}

double ScorePose(const DenseMap& map, const std::vector<Vector3f>& points, const Pose& T_map_odom) {
  const Eigen::Matrix3f R = T_map_odom.linear().cast<float>() / static_cast<float>(map.voxel_m);
  const Vector3f t = (T_map_odom.translation() / map.voxel_m).cast<float>();
  std::int64_t sum = 0;
  for (const Vector3f& p : points) {
    const Vector3f q = R * p + t;
    const std::int64_t index =
        map.IndexOf(static_cast<int>(std::floor(q.x())), static_cast<int>(std::floor(q.y())),
                    static_cast<int>(std::floor(q.z())));
    if (index >= 0) sum += map.score[static_cast<std::size_t>(index)];
  }
  return points.empty() ? 0 : static_cast<double>(sum) / static_cast<double>(points.size());
}

std::vector<Vector3f> RefinePoints(const LocalScan& scan, const Vector3d& p_foot_odom,
                                   const LocalizeConfig& config) {
  PointChoice choice;
  choice.p_foot_odom = p_foot_odom;
  choice.reach_m = config.reach_m;
  choice.low_m = -1.0;  // the ground, and stairs going down
  choice.high_m = 3.0;
  choice.apart_m = 0.15;
  choice.count = config.refine_points;
  return ChoosePoints(scan.points_odom(), choice);
}

void Refine(const DenseMap& map, const std::vector<Vector3f>& points, const Vector3d& p_foot_odom,
            const LocalizeConfig& config, Hypothesis& hypothesis) {
  Vector3d p_map = hypothesis.T_map_odom * p_foot_odom;
  const double z0 = p_map.z();
  double yaw = YawOf(hypothesis.T_map_odom);
  double best = ScorePose(map, points, hypothesis.T_map_odom);
  double step_m = config.place_step_m / 2, step_rad = DegToRad(config.yaw_step_deg / 2);
  constexpr std::array<std::array<int, 4>, 8> kMoves = {{{1, 0, 0, 0},
                                                         {-1, 0, 0, 0},
                                                         {0, 1, 0, 0},
                                                         {0, -1, 0, 0},
                                                         {0, 0, 0, 1},
                                                         {0, 0, 0, -1},
                                                         {0, 0, 1, 0},
                                                         {0, 0, -1, 0}}};
  for (int halving = 0; halving < 4; ++halving, step_m /= 2, step_rad /= 2) {
    for (int moves = 0, idle = 0; moves < 20 && idle < 8; ++moves) {
      bool has_moved = false;
      for (const auto& move : kMoves) {
        const Vector3d p = p_map + step_m * Vector3d(move[0], move[1], move[2]);
        if (std::abs(p.z() - z0) > config.slack_z_m) continue;
        const double turned = yaw + step_rad * move[3];
        const double score = ScorePose(map, points, PlaceAt(p, turned, p_foot_odom));
        if (score <= best) continue;
        best = score, p_map = p, yaw = turned, has_moved = true;
      }
      if (!has_moved) break;
    }
  }
  hypothesis.T_map_odom = PlaceAt(p_map, yaw, p_foot_odom);
  hypothesis.score = best;
}

}  // namespace crossnav::localization
