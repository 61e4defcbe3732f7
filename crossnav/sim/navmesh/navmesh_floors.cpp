// SPDX-License-Identifier: MIT
// Floors and the links between them, from the navmesh alone. The surface is sampled on a 0.1 m
// grid; a level is connected flat area of at least 4 m2, heights within 0.5 m merged; levels less
// than 1.5 m apart are one floor; other areas (flights, landings, ramps) link the floors that they
// touch.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "crossnav/sim/navmesh/navmesh_detail.h"
#include "crossnav/sim/navmesh/surface_samples.h"

namespace crossnav::sim {
namespace {

constexpr double kFloorGrid_m = 0.1;
constexpr double kMinFloor_m2 = 4.0;    // chosen: larger than any landing
constexpr double kMergeHeight_m = 0.5;  // chosen: sunken rooms are not storeys
constexpr double kStorey_m = 1.5;       // chosen: too low to stand upright
constexpr int kSlopeReach = 3;          // samples to each side
constexpr double kMaxSlope = 0.21;      // tan 12 degrees; flights rise at 20 and more
constexpr double kOnFloor_m = 0.25;     // chosen: above any threshold, below two risers

/// Steepness along both axes over a window that is longer than a tread.
bool IsFlat(const std::vector<SurfaceSample>& samples, const SurfaceSample& s) {
  const auto walk = [&](std::size_t direction, int& steps) {
    const SurfaceSample* at = &s;
    for (steps = 0; steps < kSlopeReach && at->next[direction] >= 0; ++steps) {
      at = &samples[static_cast<std::size_t>(at->next[direction])];
    }
    return at->z;
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    int ahead = 0, behind = 0;
    const double rise = walk(axis, ahead) - walk(axis + 2, behind);
    if (ahead + behind > 0 && std::abs(rise) > kMaxSlope * (ahead + behind) * kFloorGrid_m)
      return false;
  }
  return true;
}

struct Level {
  double z = 0;  // area-weighted mean of its flat parts
  double area_m2 = 0;
};

/// Flat components large enough, merged while neighbours in height are within kMergeHeight_m.
std::vector<Level> FindLevels(const std::vector<SurfaceSample>& samples) {
  std::vector<char> flat(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) flat[i] = IsFlat(samples, samples[i]) ? 1 : 0;
  int count = 0;
  const auto label = Components(samples, count, [&](std::size_t i) { return flat[i] != 0; });
  std::vector<Level> parts(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (label[i] < 0) continue;
    Level& part = parts[static_cast<std::size_t>(label[i])];
    part.area_m2 += kFloorGrid_m * kFloorGrid_m;
    part.z += samples[i].z;
  }
  for (Level& part : parts) part.z /= part.area_m2 / (kFloorGrid_m * kFloorGrid_m);
  std::sort(parts.begin(), parts.end(), [](const Level& a, const Level& b) { return a.z < b.z; });
  std::vector<Level> levels;
  for (const Level& part : parts) {
    if (part.area_m2 < kMinFloor_m2) continue;
    if (!levels.empty() && part.z - levels.back().z < kMergeHeight_m) {
      Level& level = levels.back();
      const double total = level.area_m2 + part.area_m2;
      level = {(level.z * level.area_m2 + part.z * part.area_m2) / total, total};
    } else {
      levels.push_back(part);
    }
  }
  return levels;
}

int NearestLevel(const std::vector<Floor>& floors, double z) {
  int best = -1;
  for (const Floor& floor : floors) {
    if (best < 0 || floor.GapTo(z) < floors[static_cast<std::size_t>(best)].GapTo(z)) {
      best = floor.id;
    }
  }
  return best;
}

/// Floors without their areas, from the lowest up. Measured from a floor's lowest level: a house of
/// half storeys must not become one floor.
std::vector<Floor> FloorsOf(const std::vector<SurfaceSample>& samples) {
  std::vector<Floor> floors;
  double largest_m2 = 0;  // level of the last floor
  for (const Level& level : FindLevels(samples)) {
    if (floors.empty() || level.z - floors.back().levels_m.front() >= kStorey_m) {
      floors.push_back({static_cast<int>(floors.size()), level.z, 0, {}});
      largest_m2 = 0;
    }
    floors.back().levels_m.push_back(level.z);
    if (level.area_m2 <= largest_m2) continue;
    largest_m2 = level.area_m2;
    floors.back().height_m = level.z;
  }
  if (!floors.empty() || samples.empty()) return floors;
  double z = 0;  // less walkable ground than a floor needs: all of it is one
  for (const SurfaceSample& s : samples) z += s.z / static_cast<double>(samples.size());
  floors.push_back({0, z, 0, {z}});
  return floors;
}

/// Pairs of floors, the lower first, that meet or that a connected piece of flight touches both.
/// `on_floor`: of each sample, -1 on a flight.
std::set<std::pair<int, int>> JoinedFloors(const std::vector<SurfaceSample>& samples,
                                           const std::vector<int>& on_floor) {
  int count = 0;
  const auto flight = Components(samples, count, [&](std::size_t i) { return on_floor[i] < 0; });
  std::vector<std::set<int>> touches(static_cast<std::size_t>(count));
  std::set<std::pair<int, int>> joined;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const int next : samples[i].next) {
      if (next < 0) continue;
      const int other = on_floor[static_cast<std::size_t>(next)];
      if (flight[i] >= 0 && other >= 0) touches[static_cast<std::size_t>(flight[i])].insert(other);
      if (on_floor[i] >= 0 && other > on_floor[i]) joined.emplace(on_floor[i], other);
    }
  }
  for (const std::set<int>& floors : touches)
    for (auto a = floors.begin(); a != floors.end(); ++a)
      for (auto b = std::next(a); b != floors.end(); ++b) joined.emplace(*a, *b);
  return joined;
}

}  // namespace

FloorPlan FindFloors(const dtNavMesh& mesh) {
  FloorPlan plan;
  std::vector<WorldTriangle> triangles;
  ForEachDetailTriangle(mesh, [&](dtPolyRef, const WorldTriangle& t) {
    plan.area_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    triangles.push_back(t);
  });
  const std::vector<SurfaceSample> samples = SampleSurface(triangles, kFloorGrid_m);
  plan.floors = FloorsOf(samples);
  if (plan.floors.empty()) return plan;
  std::vector<int> on_floor(samples.size(), -1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int nearest = NearestLevel(plan.floors, samples[i].z);
    Floor& floor = plan.floors[static_cast<std::size_t>(nearest)];
    if (floor.GapTo(samples[i].z) > kOnFloor_m) continue;
    floor.area_m2 += kFloorGrid_m * kFloorGrid_m;
    on_floor[i] = nearest;
  }
  for (const auto& [a, b] : JoinedFloors(samples, on_floor)) {
    plan.connections.push_back({a, b,
                                plan.floors[static_cast<std::size_t>(b)].height_m -
                                    plan.floors[static_cast<std::size_t>(a)].height_m});
  }
  return plan;
}

}  // namespace crossnav::sim
