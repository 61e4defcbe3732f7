// SPDX-License-Identifier: MIT
#include "crossnav/world/change/passages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "crossnav/world/change/free_space.h"
#include "crossnav/world/change/object_words.h"

namespace crossnav::world {
namespace {

constexpr double kWidest_m = 1.6;      // chosen: two leaves
constexpr double kNarrowest_m = 0.4;   // chosen: too narrow for a body
constexpr double kOneDoorway_m = 0.9;  // chosen: crossings nearer to each other are one
constexpr double kLeafNear_m = 0.3;    // chosen: an open leaf touches its doorway
constexpr double kOnFlight_m = 0.35;   // chosen: above the second tread, below the third

/// Steps of the ground grid between two rooms.
struct Crossing {
  int room_a = 0, room_b = 0;
  Vector3d p_world = Vector3d::Zero();
  Vector3d along = Vector3d::Zero();  ///< unit, from a to b
};

std::vector<Crossing> CrossingsOf(const HouseView& view) {
  std::map<std::array<int, 2>, std::vector<std::pair<int, Vector3d>>> columns;
  const auto column_of = [](const Vector3d& p) {
    return std::array<int, 2>{static_cast<int>(std::lround(p.x() / kGroundGrid_m)),
                              static_cast<int>(std::lround(p.y() / kGroundGrid_m))};
  };
  for (std::size_t i = 0; i < view.rooms.size(); ++i) {
    for (const Vector3d& p : view.rooms[i].ground) {
      columns[column_of(p)].emplace_back(static_cast<int>(i), p);
    }
  }
  std::vector<Crossing> crossings;
  for (const auto& [column, points] : columns) {
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
      const auto next = columns.find({column[0] + dx, column[1] + dy});
      if (next == columns.end()) continue;
      for (const auto& [room, p] : points) {
        for (const auto& [other, q] : next->second) {
          if (room == other || std::abs(p.z() - q.z()) > 0.3) continue;
          Crossing crossing{room, other, 0.5 * (p + q), (q - p).normalized()};
          crossing.along.z() = 0;
          if (room > other) {
            std::swap(crossing.room_a, crossing.room_b);
            crossing.along = -crossing.along;
          }
          crossings.push_back(crossing);
        }
      }
    }
  }
  std::stable_sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
    return std::pair(a.room_a, a.room_b) < std::pair(b.room_a, b.room_b);
  });
  return crossings;
}

/// Free width at `p_world` across `yaw_rad`, and its middle.
struct Section {
  double width_m = 1e9;
  Vector3d middle_world = Vector3d::Zero();
  double yaw_rad = 0;
};

Section SectionAt(const sim::RayCaster& caster, const Vector3d& p_world, double yaw_rad, int leaf,
                  std::initializer_list<double> heights_m) {
  const Vector3d side(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  double left_m = 1e9, right_m = 1e9;
  for (const double height_m : heights_m) {
    const Vector3d eye = p_world + Vector3d(0, 0, height_m);
    left_m = std::min(left_m, FreeLength(caster, eye, side, leaf, kWidest_m + 1));
    right_m = std::min(right_m, FreeLength(caster, eye, -side, leaf, kWidest_m + 1));
  }
  return {left_m + right_m, p_world + side * (0.5 * (left_m - right_m)), yaw_rad};
}

/// Narrowest of several sections across `along` near a place, turned by up to `most_deg`: on a
/// flight, a section far from square would meet treads instead of walls.
Section NarrowestSection(const sim::RayCaster& caster, const Vector3d& p_world,
                         const Vector3d& along, int leaf, double most_deg) {
  constexpr double kWorthIt_m = 0.01;  // chosen: least gain over the middle section
  const double across_rad = std::atan2(along.y(), along.x()) + std::numbers::pi / 2;
  const std::initializer_list<double> heights_m = {0.3, 0.6, 0.93};
  Section best;
  for (const double off_m : {0.0, -0.05, 0.05, -0.1, 0.1, -0.2, 0.2, -0.3, 0.3}) {
    for (const double share : {0.0, -1 / 3.0, 1 / 3.0, -2 / 3.0, 2 / 3.0, -1.0, 1.0}) {
      const Section section = SectionAt(caster, p_world + off_m * along,
                                        across_rad + DegToRad(share * most_deg), leaf, heights_m);
      if (section.width_m < best.width_m - kWorthIt_m) best = section;
    }
  }
  return best;
}

/// Door whose box is at the doorway, nearest first.
int LeafAt(const sim::Scene& scene, const Vector3d& p_world) {
  int best = 0;
  double nearest_m = 1e9;
  for (const sim::SceneInstance& instance : scene.instances) {
    if (instance.box.empty() || !IsDoor(instance.name)) continue;
    if (std::abs(instance.box.min.z() - p_world.z()) > 0.4) continue;
    if (instance.box.HorizontalDistance(p_world) > kLeafNear_m + 0.5) continue;
    const double distance_m = instance.box.HorizontalDistance(p_world);
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    best = instance.id;
  }
  return best;
}

void SetBoard(const Section& section, double ground_z, Passage& passage) {
  passage.board.centre_world = section.middle_world;
  passage.board.centre_world.z() = ground_z;
  passage.board.yaw_rad = section.yaw_rad;
  passage.board.length_m = section.width_m;
}

bool IsBarrable(const Section& section) {
  return section.width_m >= kNarrowest_m && section.width_m <= kWidest_m;
}

void AddDoorways(const sim::Scene& scene, const sim::RayCaster& caster, const HouseView& view,
                 std::vector<Passage>& passages) {
  std::vector<std::pair<Crossing, int>> doorways;  // sums of crossings, and their counts
  for (const Crossing& crossing : CrossingsOf(view)) {
    const auto same = std::find_if(doorways.begin(), doorways.end(), [&](const auto& doorway) {
      const Vector3d middle = doorway.first.p_world / doorway.second;
      return doorway.first.room_a == crossing.room_a && doorway.first.room_b == crossing.room_b &&
             (middle - crossing.p_world).norm() < kOneDoorway_m;
    });
    if (same == doorways.end()) {
      doorways.emplace_back(crossing, 1);
      continue;
    }
    same->first.p_world += crossing.p_world;
    same->first.along += crossing.along;
    ++same->second;
  }
  for (auto& [sum, count] : doorways) {
    Passage passage;
    passage.room_a = sum.room_a;
    passage.room_b = sum.room_b;
    const Vector3d middle = sum.p_world / count;
    const Vector3d along =
        sum.along.norm() > 0.1 ? Vector3d(sum.along.normalized()) : Vector3d(Vector3d::UnitX());
    passage.leaf = LeafAt(scene, middle);
    const Section section = NarrowestSection(caster, middle, along, passage.leaf, 45);
    SetBoard(section, middle.z(), passage);
    passage.a_world = middle - 0.5 * along;
    passage.b_world = middle + 0.5 * along;
    if (!IsBarrable(section)) passage.board.length_m = 0;  // a detour, but no place to bar
    passages.push_back(passage);
  }
}

int RoomNearest(const HouseView& view, const Vector3d& p_world, Vector3d* ground) {
  int best = -1;
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < view.rooms.size(); ++i) {
    for (const Vector3d& p : view.rooms[i].ground) {
      const double distance_m = (p - p_world).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      best = static_cast<int>(i);
      *ground = p;
    }
  }
  return best;
}

/// First point of a path `rise_m` above its lower end, and the direction there.
std::optional<std::pair<Vector3d, Vector3d>> PointAbove(std::vector<Vector3d> way, double rise_m) {
  if (way.size() < 2) return std::nullopt;
  if (way.front().z() > way.back().z()) std::reverse(way.begin(), way.end());
  const double z = way.front().z() + rise_m;
  for (std::size_t i = 1; i < way.size(); ++i) {
    if (way[i].z() < z) continue;
    Vector3d along = way[i] - way[i - 1];
    const double share = (z - way[i - 1].z()) / std::max(along.z(), 1e-6);
    const Vector3d p = way[i - 1] + std::clamp(share, 0.0, 1.0) * along;
    along.z() = 0;
    if (along.norm() < 1e-6) continue;
    return std::make_pair(p, Vector3d(along.normalized()));
  }
  return std::nullopt;
}

void AddFlights(const sim::Scene& scene, const sim::RayCaster& caster, const HouseView& view,
                std::vector<Passage>& passages) {
  for (const sim::SceneInstance& stairs : scene.instances) {
    if (stairs.box.empty() || !IsStairs(stairs.name)) continue;
    Passage passage;
    passage.is_flight = true;
    Vector3d low = stairs.box.Center(), high = stairs.box.Center();
    low.z() = stairs.box.min.z();
    high.z() = stairs.box.max.z() + 0.1;
    passage.room_a = RoomNearest(view, low, &passage.a_world);
    passage.room_b = RoomNearest(view, high, &passage.b_world);
    if (passage.room_a < 0 || passage.room_b < 0) continue;
    const auto at =
        PointAbove(view.navmesh->ShortestPath(passage.a_world, passage.b_world), kOnFlight_m);
    passage.board.length_m = 0;
    if (at && stairs.box.HorizontalDistance(at->first) < 0.3) {
      const Section section = NarrowestSection(caster, at->first, at->second, 0, 10);
      SetBoard(section, at->first.z() - 0.2, passage);  // into the tread
      if (!IsBarrable(section)) passage.board.length_m = 0;
    }
    passages.push_back(passage);
  }
}

}  // namespace

std::vector<Passage> PassagesOf(const sim::Scene& scene, const sim::RayCaster& caster,
                                const HouseView& view) {
  std::vector<Passage> passages;
  AddDoorways(scene, caster, view, passages);
  AddFlights(scene, caster, view, passages);
  return passages;
}

std::vector<int> CutOffWithout(const std::vector<Passage>& passages, std::size_t index,
                               const HouseView& view) {
  std::vector<int> group(view.rooms.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<int>(i);
  for (std::size_t i = 0; i < passages.size(); ++i) {
    if (i == index) continue;
    const int a = group[static_cast<std::size_t>(passages[i].room_a)];
    const int b = group[static_cast<std::size_t>(passages[i].room_b)];
    for (int& g : group) g = g == a ? b : g;
  }
  const int a = group[static_cast<std::size_t>(passages[index].room_a)];
  const int b = group[static_cast<std::size_t>(passages[index].room_b)];
  if (a == b) return {};
  std::vector<int> side_a, side_b;
  double area_a_m2 = 0, area_b_m2 = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] == a) side_a.push_back(static_cast<int>(i)), area_a_m2 += view.rooms[i].AreaM2();
    if (group[i] == b) side_b.push_back(static_cast<int>(i)), area_b_m2 += view.rooms[i].AreaM2();
  }
  return area_a_m2 < area_b_m2 ? side_a : side_b;
}

}  // namespace crossnav::world
