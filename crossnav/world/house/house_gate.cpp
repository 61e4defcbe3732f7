// SPDX-License-Identifier: MIT
#include "crossnav/world/house/house_gate.h"

#include <fmt/format.h>

#include <set>

#include "crossnav/world/furniture/furnish.h"
#include "crossnav/world/furniture/groups.h"
#include "crossnav/world/layout/edition.h"

namespace crossnav::world {
namespace {

constexpr double kSample_m = 0.35;       // chosen: grid on which rooms are probed
constexpr double kReachableShare = 0.6;  // chosen: share of a room's walkable ground

constexpr double kLargestDrawn_m2 = 960;  // chosen: four floors of 240 m2 (house_generator.cpp)
constexpr std::uintmax_t kDrawnBytes = 40'000'000;

tl::unexpected<Error> Refuse(std::string what, std::string where) {
  return Fail(ErrorCode::kInvalid, std::move(what), std::move(where));
}

Result<void> CheckCategories(const sim::Scene& scene) {
  std::set<std::string> seen;
  for (const auto& instance : scene.instances) {
    if (!instance.category.empty()) seen.insert(instance.category);
  }
  if (seen.size() < 5) return Refuse("fewer than five categories", scene.id);
  return {};
}

/// Places of a room on a grid.
struct Probe {
  int walkable = 0, reached = 0;  ///< number of places; reached: from `start`
};

/// `start` becomes the first walkable place if empty.
Probe ProbeRoom(const Room& room, double z_m, const sim::NavMesh& navmesh,
                std::optional<Vector3d>* start) {
  Probe probe;
  for (const Rect& whole : room.rects) {
    const Rect r = whole.Grown(-0.3);
    for (double x = r.x0; x <= r.x1; x += kSample_m) {
      for (double y = r.y0; y <= r.y1; y += kSample_m) {
        const auto p = navmesh.Snap({x, y, z_m}, 0.05, 0.25);
        if (!p) continue;
        if (!*start) *start = p;
        ++probe.walkable;
        probe.reached += navmesh.Geodesic(**start, *p).has_value() ? 1 : 0;
      }
    }
  }
  return probe;
}

/// A room that cannot be used, and the reason.
struct Blocked {
  int room = -1;
  std::string what;
};

std::optional<Blocked> FindBlocked(const HousePlan& plan, const sim::NavMesh& navmesh) {
  std::optional<Vector3d> start;  // in the first room, the hall of the lowest level
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const Room& room = plan.rooms[i];
    if (room.type == RoomType::kVoid) continue;
    const double z_m = plan.levels[static_cast<std::size_t>(room.level)].floor_m + room.offset_m;
    const Probe probe = ProbeRoom(room, z_m, navmesh, &start);
    const int index = static_cast<int>(i);
    if (probe.walkable == 0) return Blocked{index, "no walkable ground in a room"};
    if (probe.reached < kReachableShare * probe.walkable) {
      return Blocked{index, "a room is cut off"};
    }
  }
  return std::nullopt;
}

Result<void> CheckRooms(const HousePlan& plan, const sim::NavMesh& navmesh) {
  const auto blocked = FindBlocked(plan, navmesh);
  if (!blocked) return {};
  const Room& room = plan.rooms[static_cast<std::size_t>(blocked->room)];
  return Refuse(blocked->what,
                fmt::format("{} {} on level {}", room.name, blocked->room, room.level));
}

/// Checks that every floor of the navmesh reaches every other floor.
Result<void> CheckFloors(const HousePlan& plan, const sim::NavMesh& navmesh) {
  const auto& floors = navmesh.Floors();
  if (floors.size() < plan.levels.size()) return Refuse("a floor has no walkable ground", plan.id);
  std::vector<int> group(floors.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<int>(i);
  for (const auto& link : navmesh.Connections()) {
    const int a = group[static_cast<std::size_t>(link.lower)];
    const int b = group[static_cast<std::size_t>(link.upper)];
    for (int& g : group) g = g == a ? b : g;
  }
  for (int g : group) {
    if (g != group[0]) return Refuse("floors are not connected", plan.id);
  }
  return {};
}

Result<void> CheckFurniture(const HousePlan& plan) {
  std::vector<Box3> boxes;
  for (const auto& p : plan.furniture) boxes.push_back(BoxAt(p.model, p.T_world_object));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (plan.furniture[i].room != plan.furniture[j].room) continue;
      const Vector3d shared =
          boxes[i].max.cwiseMin(boxes[j].max) - boxes[i].min.cwiseMax(boxes[j].min);
      if (shared.minCoeff() > 2 * kOverlapTolerance_m) {
        return Refuse("furniture intersects",
                      plan.furniture[i].model.name + " and " + plan.furniture[j].model.name);
      }
    }
  }
  return {};
}

}  // namespace

std::optional<int> BlockedRoom(const HousePlan& plan, const sim::NavMesh& navmesh) {
  const auto blocked = FindBlocked(plan, navmesh);
  return blocked ? std::optional(blocked->room) : std::nullopt;
}

std::uintmax_t MostBytesOf(int edition, double built_m2) {
  return built_m2 > kLargestDrawn_m2 ? EditionOf(edition).most_bytes : kDrawnBytes;
}

Result<void> CheckHouse(const HousePlan& plan, const sim::Scene& scene,
                        const sim::NavMesh& navmesh) {
  if (auto ok = CheckCategories(scene); !ok) return ok;
  if (auto ok = CheckFurniture(plan); !ok) return ok;
  if (auto ok = CheckFloors(plan, navmesh); !ok) return ok;
  return CheckRooms(plan, navmesh);
}

}  // namespace crossnav::world
