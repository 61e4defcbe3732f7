// SPDX-License-Identifier: MIT
#include "crossnav/world/change/day_gate.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "crossnav/sim/sensing/scene_info.h"

namespace crossnav::world {
namespace {

constexpr double kDayReachableShare = 0.6;  // as for rooms of a generated house
constexpr std::size_t kMinCategories = 5;   // as for a generated house

tl::unexpected<Error> RefuseDay(std::string what, std::string where) {
  return Fail(ErrorCode::kInvalid, std::move(what), std::move(where));
}

bool IsShut(const ShutRooms& shut, const RoomView& room) {
  return shut.contains({room.floor, room.region});
}

/// A still walkable place of the first day's largest part, not behind a shut door.
std::optional<Vector3d> StartOn(const HouseView& first, const sim::NavMesh& navmesh,
                                const ShutRooms& shut) {
  const RoomView* largest = nullptr;
  for (const RoomView& room : first.rooms) {
    if (IsShut(shut, room)) continue;
    if (largest == nullptr || room.ground.size() > largest->ground.size()) largest = &room;
  }
  if (largest == nullptr) return std::nullopt;
  for (const Vector3d& p : largest->ground) {
    if (const auto snapped = navmesh.Snap(p, 0.05, 0.25)) return snapped;
  }
  return std::nullopt;
}

struct RoomReach {
  int walkable = 0, reached = 0;  ///< points of the first day's ground
  bool IsEnough() const { return walkable > 0 && reached >= kDayReachableShare * walkable; }
};

RoomReach ReachOf(const RoomView& room, const sim::NavMesh& navmesh, const Vector3d& start_world) {
  constexpr std::size_t kEvery = 4;  // chosen: one point per .3 m, as in the generator's gate
  RoomReach reach;
  for (std::size_t i = 0; i < room.ground.size(); i += kEvery) {
    const auto p = navmesh.Snap(room.ground[i], 0.05, 0.25);
    if (!p) continue;
    ++reach.walkable;
    reach.reached += navmesh.Geodesic(start_world, *p).has_value() ? 1 : 0;
  }
  return reach;
}

std::string NameOf(const RoomView& room) {
  return fmt::format("room {} on floor {}", room.region, room.floor);
}

Result<void> CheckRooms(const HouseView& first, const sim::NavMesh& navmesh, const ShutRooms& shut,
                        const Vector3d& start_world) {
  for (const RoomView& room : first.rooms) {
    if (IsShut(shut, room)) continue;
    const RoomReach reach = ReachOf(room, navmesh, start_world);
    if (reach.walkable == 0) return RefuseDay("no walkable ground in a room", NameOf(room));
    if (!reach.IsEnough()) return RefuseDay("a room is cut off", NameOf(room));
  }
  return {};
}

bool IsViewable(const sim::Scene& scene, const sim::NavMesh& navmesh, const sim::RayCaster& caster,
                const sim::SceneInstance& instance, const Vector3d& start_world) {
  const auto viewpoints = sim::Viewpoints(scene, navmesh, caster, instance, SensorConfig());
  return !viewpoints.empty() && navmesh.Geodesic(start_world, viewpoints).has_value();
}

std::set<std::string> CategoriesOf(const sim::Scene& scene) {
  std::set<std::string> categories;
  for (const auto& instance : scene.instances) {
    if (!instance.category.empty() && !instance.box.empty()) categories.insert(instance.category);
  }
  return categories;
}

/// Whether an instance of `category` can be viewed.
bool IsAnyViewable(const sim::Scene& scene, const sim::NavMesh& navmesh,
                   const sim::RayCaster& caster, const std::string& category,
                   const Vector3d& start_world) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& instance) {
    return instance.category == category && !instance.box.empty() &&
           IsViewable(scene, navmesh, caster, instance, start_world);
  });
}

Result<void> CheckCategories(const HouseView& first, const sim::Scene& first_scene,
                             const sim::Scene& scene, const sim::NavMesh& navmesh,
                             const sim::RayCaster& caster, const Vector3d& start_world) {
  const auto before = CategoriesOf(first_scene), now = CategoriesOf(scene);
  if (now.size() < std::min(kMinCategories, before.size())) {
    return RefuseDay("fewer than five categories", scene.id);
  }
  for (const std::string& category : now) {
    if (!before.contains(category)) continue;
    if (IsAnyViewable(scene, navmesh, caster, category, start_world)) continue;
    // In imported homes a category may have been out of reach on the first day.
    const sim::RayCaster first_caster(first_scene);
    if (IsAnyViewable(first_scene, *first.navmesh, first_caster, category, first.start_world))
      return RefuseDay("no instance can be viewed", category);
  }
  return {};
}

Result<void> CheckChanged(const sim::Scene& scene, const sim::NavMesh& navmesh,
                          const sim::RayCaster& caster, const Vector3d& start_world,
                          const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    if (!IsMove(change.kind) && change.kind != ChangeKind::kAdded) continue;
    const auto* instance = scene.FindInstance(change.instance);
    if (instance == nullptr || !IsViewable(scene, navmesh, caster, *instance, start_world)) {
      return RefuseDay("a changed object cannot be viewed", change.name);
    }
  }
  return {};
}

}  // namespace

Result<void> CheckDay(const HouseView& first, const sim::Scene& first_scene, const JudgedDay& day,
                      const sim::NavMesh& navmesh) {
  const sim::Scene& scene = day.scene;
  if (navmesh.Floors().size() < first.navmesh->Floors().size()) {
    return RefuseDay("a floor has no walkable ground", scene.id);
  }
  const auto start = StartOn(first, navmesh, day.shut);
  if (!start) return RefuseDay("no walkable ground", scene.id);
  if (auto ok = CheckRooms(first, navmesh, day.shut, *start); !ok) return ok;
  const sim::RayCaster caster(scene);
  if (auto ok = CheckChanged(scene, navmesh, caster, *start, day.changes); !ok) return ok;
  return CheckCategories(first, first_scene, scene, navmesh, caster, *start);
}

sim::NavMeshSettings WithRoomToSpare(sim::NavMeshSettings settings) {
  constexpr double kSpare_m = 0.1;  // chosen: a voxel of the robot's map on each side
  settings.agent_radius_m += kSpare_m;
  return settings;
}

Result<void> CheckWays(const HouseView& first, const sim::NavMesh& first_spare,
                       const sim::NavMesh& spare, const ShutRooms& shut) {
  const auto start = StartOn(first, spare, shut), first_start = StartOn(first, first_spare, shut);
  if (!first_start) return {};
  if (!start) return RefuseDay("no ground with room to spare", "");
  for (const RoomView& room : first.rooms) {
    if (IsShut(shut, room)) continue;
    // A home may have narrow ways from the first day on.
    if (ReachOf(room, first_spare, *first_start).IsEnough() &&
        !ReachOf(room, spare, *start).IsEnough())
      return RefuseDay("the way to a room is as narrow as the body", NameOf(room));
  }
  return {};
}

}  // namespace crossnav::world
