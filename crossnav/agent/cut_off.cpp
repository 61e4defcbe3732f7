// SPDX-License-Identifier: MIT
#include "crossnav/agent/cut_off.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_set>
#include <vector>

#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

using geometry::VoxelKey;

namespace {

constexpr double kEnd_m = 1.0;      // chosen: ground this near to the end of a flight belongs to it
constexpr double kGround_m2 = 1.0;  // chosen: less is a corner behind furniture
constexpr double kLevelBand_m = 0.3;  // chosen: lower than a seat

using Places = std::unordered_set<VoxelKey, geometry::VoxelKeyHash>;

Places Reached(const Situation& now, const VoxelKey& start) {
  Places reached;
  planner::GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  while (const auto place = search.Next()) reached.insert(*place);
  return reached;
}

bool IsAnyNear(const Places& reached, const Vector3d& p_world, double voxel_m) {
  return std::any_of(reached.begin(), reached.end(), [&](const VoxelKey& key) {
    const Vector3d d = CenterOf(key, voxel_m) - p_world;
    return d.head<2>().norm() <= kEnd_m && std::abs(d.z()) <= kLevelBand_m + voxel_m;
  });
}

int CutOffLevels(const Situation& now, const Places& reached) {
  const double voxel_m = now.config.map.voxel_m;
  return static_cast<int>(
      std::count_if(now.world.levels_m.begin(), now.world.levels_m.end(), [&](double level_m) {
        return std::none_of(reached.begin(), reached.end(), [&](const VoxelKey& key) {
          return std::abs(FootOf(key, voxel_m).z() - level_m) <= kLevelBand_m;
        });
      }));
}

int CutOffFlights(const Situation& now, const Places& reached) {
  const auto& flights = now.world.flights;
  return static_cast<int>(
      std::count_if(flights.begin(), flights.end(), [&](const geometry::StairFlight& flight) {
        return !IsAnyNear(reached, flight.p_foot_world, now.config.map.voxel_m) ||
               !IsAnyNear(reached, flight.p_top_world, now.config.map.voxel_m);
      }));
}

double CutOffGround(const Situation& now, const Places& reached) {
  const double voxel_m = now.config.map.voxel_m;
  int count = 0;
  now.world.map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    if (!geometry::IsSurface(voxel.state)) return;
    const VoxelKey place{key.x, key.y, key.z + 1};
    const double z_m = FootOf(place, voxel_m).z();
    const bool is_on_level =
        std::any_of(now.world.levels_m.begin(), now.world.levels_m.end(),
                    [&](double level_m) { return std::abs(z_m - level_m) <= kLevelBand_m; });
    count += is_on_level && now.world.ground.IsStanding(place) && !reached.contains(place);
  });
  const double ground_m2 = count * voxel_m * voxel_m;
  return ground_m2 < kGround_m2 ? 0 : ground_m2;
}

void Append(int count, const char* one, std::string* text) {
  if (count == 0) return;
  if (!text->empty()) *text += ", ";
  *text += std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

CutOff FindCutOff(const Situation& now) {
  CutOff cut_off;
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  const Places reached = start ? Reached(now, *start) : Places();
  cut_off.levels = CutOffLevels(now, reached);
  cut_off.flights = CutOffFlights(now, reached);
  cut_off.places = static_cast<int>(std::count_if(
      now.goal.history.begin(), now.goal.history.end(),
      [](const HistoryPoi& poi) { return !poi.is_exhausted && poi.unreachable_step; }));
  cut_off.ground_m2 = CutOffGround(now, reached);
  cut_off.reached_m2 =
      static_cast<double>(reached.size()) * now.config.map.voxel_m * now.config.map.voxel_m;
  return cut_off;
}

std::string Describe(const CutOff& cut_off) {
  std::string text;
  Append(cut_off.levels, "level", &text);
  Append(cut_off.flights, "flight", &text);
  Append(cut_off.places, "remembered place", &text);
  if (cut_off.ground_m2 > 0) {
    char ground[40];
    std::snprintf(ground, sizeof ground, "%.1f m2 of ground", cut_off.ground_m2);
    text += (text.empty() ? "" : ", ") + std::string(ground);
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace crossnav::agent
