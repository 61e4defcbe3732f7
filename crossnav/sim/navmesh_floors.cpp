// SPDX-License-Identifier: MIT
// Floors and the links between them, from the navmesh alone. The surface is sampled on a 0.1 m
// grid; a level is connected flat area of at least 4 m2, heights within 0.5 m merged; levels less
// than 1.5 m apart are one floor; what is neither (flights, landings, ramps) links the floors that
// it touches.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "crossnav/sim/navmesh_detail.h"

namespace crossnav::sim {
namespace {

constexpr double kGrid_m = 0.1;
constexpr double kMinFloor_m2 = 4.0;    // chosen: larger than any landing
constexpr double kMergeHeight_m = 0.5;  // chosen: sunken rooms are not storeys
constexpr double kStorey_m = 1.5;       // chosen: nobody stands upright in less
constexpr double kSameStep_m = 0.30;    // neighbours further apart in height are not connected
constexpr int kSlopeReach = 3;          // samples to each side
constexpr double kMaxSlope = 0.21;      // tan 12 degrees; flights rise at 20 and more
constexpr double kOnFloor_m = 0.25;     // chosen: above any threshold, below two risers

struct Sample {
  int x = 0, y = 0;
  double z = 0;
  std::array<int, 4> next{-1, -1, -1, -1};  // +x, +y, -x, -y
};

/// Grid points covered by triangle `t`, with the height there.
void SampleTriangle(const WorldTriangle& t, std::vector<Sample>& out) {
  const double det =
      (t[1].x() - t[0].x()) * (t[2].y() - t[0].y()) - (t[2].x() - t[0].x()) * (t[1].y() - t[0].y());
  if (std::abs(det) < 1e-12) return;
  const auto [x_low, x_high] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [y_low, y_high] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  for (int x = static_cast<int>(std::ceil(x_low / kGrid_m)); x * kGrid_m <= x_high; ++x) {
    for (int y = static_cast<int>(std::ceil(y_low / kGrid_m)); y * kGrid_m <= y_high; ++y) {
      const double px = x * kGrid_m - t[0].x(), py = y * kGrid_m - t[0].y();
      const double s = (px * (t[2].y() - t[0].y()) - py * (t[2].x() - t[0].x())) / det;
      const double r = (py * (t[1].x() - t[0].x()) - px * (t[1].y() - t[0].y())) / det;
      if (s < -1e-9 || r < -1e-9 || s + r > 1 + 1e-9) continue;
      out.push_back({x, y, t[0].z() + s * (t[1].z() - t[0].z()) + r * (t[2].z() - t[0].z())});
    }
  }
}

struct ByPlace {
  bool operator()(const Sample& a, const Sample& b) const {
    return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z);
  }
};

std::vector<Sample> SampleSurface(const dtNavMesh& mesh) {
  std::vector<Sample> samples;
  ForEachDetailTriangle(mesh,
                        [&](dtPolyRef, const WorldTriangle& t) { SampleTriangle(t, samples); });
  std::sort(samples.begin(), samples.end(), ByPlace{});
  const auto same = [](const Sample& a, const Sample& b) {  // shared edges give a point twice
    return a.x == b.x && a.y == b.y && std::abs(a.z - b.z) < kSameStep_m;
  };
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
  return samples;
}

void LinkNeighbours(std::vector<Sample>& samples) {
  constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (Sample& s : samples) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Sample low{s.x + kSteps[k][0], s.y + kSteps[k][1], s.z - kSameStep_m};
      double nearest_m = kSameStep_m;
      for (auto it = std::lower_bound(samples.begin(), samples.end(), low, ByPlace{});
           it != samples.end() && it->x == low.x && it->y == low.y; ++it) {
        if (std::abs(it->z - s.z) > nearest_m) continue;
        nearest_m = std::abs(it->z - s.z);
        s.next[k] = static_cast<int>(it - samples.begin());
      }
    }
  }
}

/// Steepness along both axes over a window that is longer than a tread.
bool IsFlat(const std::vector<Sample>& samples, const Sample& s) {
  const auto walk = [&](std::size_t direction, int& steps) {
    const Sample* at = &s;
    for (steps = 0; steps < kSlopeReach && at->next[direction] >= 0; ++steps) {
      at = &samples[static_cast<std::size_t>(at->next[direction])];
    }
    return at->z;
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    int ahead = 0, behind = 0;
    const double rise = walk(axis, ahead) - walk(axis + 2, behind);
    if (ahead + behind > 0 && std::abs(rise) > kMaxSlope * (ahead + behind) * kGrid_m) return false;
  }
  return true;
}

/// Labels connected samples of those for which `in(sample index)`; -1 elsewhere.
template <class In>
std::vector<int> Components(const std::vector<Sample>& samples, int& count, In&& in) {
  std::vector<int> label(samples.size(), -1);
  count = 0;
  std::vector<int> open;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (label[i] >= 0 || !in(i)) continue;
    label[i] = count;
    open.assign(1, static_cast<int>(i));
    while (!open.empty()) {
      const auto at = static_cast<std::size_t>(open.back());
      open.pop_back();
      for (const int next : samples[at].next) {
        if (next < 0 || label[static_cast<std::size_t>(next)] >= 0) continue;
        if (!in(static_cast<std::size_t>(next))) continue;
        label[static_cast<std::size_t>(next)] = count;
        open.push_back(next);
      }
    }
    ++count;
  }
  return label;
}

struct Level {
  double z = 0;  // area-weighted mean of its flat parts
  double area_m2 = 0;
};

/// Flat components large enough, merged while neighbours in height are within kMergeHeight_m.
std::vector<Level> FindLevels(const std::vector<Sample>& samples) {
  std::vector<char> flat(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) flat[i] = IsFlat(samples, samples[i]) ? 1 : 0;
  int count = 0;
  const auto label = Components(samples, count, [&](std::size_t i) { return flat[i] != 0; });
  std::vector<Level> parts(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (label[i] < 0) continue;
    Level& part = parts[static_cast<std::size_t>(label[i])];
    part.area_m2 += kGrid_m * kGrid_m;
    part.z += samples[i].z;
  }
  for (Level& part : parts) part.z /= part.area_m2 / (kGrid_m * kGrid_m);
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
std::vector<Floor> FloorsOf(const std::vector<Sample>& samples) {
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
  for (const Sample& s : samples) z += s.z / static_cast<double>(samples.size());
  floors.push_back({0, z, 0, {z}});
  return floors;
}

/// Pairs of floors, the lower first, that meet or that a connected piece of flight touches both.
/// `on_floor`: of each sample, -1 on a flight.
std::set<std::pair<int, int>> JoinedFloors(const std::vector<Sample>& samples,
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
  ForEachDetailTriangle(mesh, [&](dtPolyRef, const WorldTriangle& t) {
    plan.area_m2 += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  });
  std::vector<Sample> samples = SampleSurface(mesh);
  LinkNeighbours(samples);
  plan.floors = FloorsOf(samples);
  if (plan.floors.empty()) return plan;
  std::vector<int> on_floor(samples.size(), -1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int nearest = NearestLevel(plan.floors, samples[i].z);
    Floor& floor = plan.floors[static_cast<std::size_t>(nearest)];
    if (floor.GapTo(samples[i].z) > kOnFloor_m) continue;
    floor.area_m2 += kGrid_m * kGrid_m;
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
