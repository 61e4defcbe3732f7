// SPDX-License-Identifier: MIT
#include "crossnav/world/change/night.h"

#include <algorithm>
#include <cmath>

#include "crossnav/world/change/object_words.h"
#include "crossnav/world/change/passages.h"
#include "crossnav/world/change/placement.h"

namespace crossnav::world {
namespace {

constexpr Rgb8 kLeafColour{206, 190, 164}, kBarrierColour{196, 92, 48};
constexpr double kLeafHeight_m = 2.0;     // chosen: below every frame's head
constexpr double kBarrierHeight_m = 1.1;  // chosen: nobody steps over it, a camera looks over it
constexpr double kBarrierDeep_m = 0.06;
constexpr double kInPlane_m = 0.1;  // chosen: a frame's half depth; beyond it hangs an open leaf
constexpr double kAround_m = 1.5;   // chosen: a shorter detour leads past the board
constexpr double kShutShare = 0.3;  // chosen: of the house's ground, behind one door
constexpr int kBarTries = 6;        // chosen: each costs a navmesh

std::set<int> ChangedOf(const DayChanges& list) {
  std::set<int> changed;
  for (const Change& change : list.changes) changed.insert(change.instance);
  return changed;
}

/// Whether the object's category is unique.
bool IsOnlyOfCategory(const sim::Scene& scene, const sim::SceneInstance& object) {
  return !object.category.empty() &&
         std::count_if(scene.instances.begin(), scene.instances.end(),
                       [&](const auto& i) { return i.category == object.category; }) == 1;
}

/// Whether the object's name or category is unique.
bool IsOnly(const sim::Scene& scene, const sim::SceneInstance& object) {
  return IsOnlyOfCategory(scene, object) ||
         std::count_if(scene.instances.begin(), scene.instances.end(),
                       [&](const auto& i) { return i.name == object.name; }) == 1;
}

/// Objects that may change, shuffled; goals of one instance first, then other goals.
std::vector<int> Candidates(const Night& night, bool only_by_category, Rng& rng) {
  std::vector<int> candidates;
  for (const sim::SceneInstance& object : night.scene.instances) {
    if (!MayMove(night.view, object) || night.changed.contains(object.id)) continue;
    if (only_by_category && !IsOnlyOfCategory(night.scene, object)) continue;
    candidates.push_back(object.id);
  }
  rng.Shuffle(candidates);
  const auto rank = [&](int id) {
    const sim::SceneInstance& object = *night.scene.FindInstance(id);
    return (IsOnly(night.scene, object) ? 0 : 2) + (object.category.empty() ? 1 : 0);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](int a, int b) { return rank(a) < rank(b); });
  return candidates;
}

Change ChangeOf(ChangeKind kind, const sim::SceneInstance& object) {
  Change change;
  change.kind = kind;
  change.instance = object.id;
  change.name = object.name;
  change.category = object.category;
  return change;
}

void SetRegion(sim::Scene& scene, int id, int region) {
  for (auto& instance : scene.instances) {
    if (instance.id == id) instance.region = region;
  }
}

bool ChangeObject(const ChangeWish& wish, HouseDay& day, Rng& rng) {
  Night night{wish.evening, day.scene, std::make_unique<sim::RayCaster>(day.scene),
              ChangedOf(day.list)};
  for (const int id : Candidates(night, wish.only_by_category, rng)) {
    const sim::SceneInstance object = *day.scene.FindInstance(id);
    Change change = ChangeOf(wish.kind, object);
    if (wish.kind != ChangeKind::kAdded) change.from = PlaceOf(wish.evening, object);
    if (wish.kind == ChangeKind::kRemoved) {
      RemoveInstance(day.scene, id);
    } else {
      const auto standing = FindPlace(night, object, wish.kind, rng);
      if (!standing) continue;
      change.to = standing->place;
      if (wish.kind == ChangeKind::kAdded) {
        change.instance = CopyInstance(day.scene, id, standing->shift);
      } else {
        MoveInstance(day.scene, id, standing->shift);
      }
      SetRegion(day.scene, change.instance, standing->place.room);
    }
    Settle(day.scene);
    day.list.changes.push_back(std::move(change));
    return true;
  }
  return false;
}

bool IsOfKind(const Passage& passage, ChangeKind kind) {
  if (passage.board.length_m <= 0) return false;
  switch (kind) {
    case ChangeKind::kDoorClosed:
      return !passage.is_flight && passage.leaf > 0;
    case ChangeKind::kPassageBlocked:
      return !passage.is_flight && passage.leaf == 0;
    default:
      return passage.is_flight;
  }
}

/// Inserts the board; returns its instance.
int Bar(const Passage& passage, ChangeKind kind, sim::Scene& scene) {
  Board board = passage.board;
  int id = passage.leaf;
  if (kind == ChangeKind::kDoorClosed) {
    const Vector3d out(-std::sin(board.yaw_rad), std::cos(board.yaw_rad), 0);
    const Vector3d middle = board.centre_world;
    RemoveTriangles(scene, id, [&](const Vector3d& centre) {
      return std::abs(out.dot(centre - middle)) > kInPlane_m;
    });
    board.height_m = kLeafHeight_m;
  } else {
    id = AddInstance(scene, "barrier", 0);
    board.height_m = kBarrierHeight_m + (passage.is_flight ? 0.3 : 0);
    board.thickness_m = kBarrierDeep_m;
  }
  AddBoard(scene, id, board, kind == ChangeKind::kDoorClosed ? kLeafColour : kBarrierColour);
  Settle(scene);
  return id;
}

/// Whether the board blocks: the path is gone, or a longer path leads around.
bool IsBarred(const Passage& passage, const sim::NavMesh& open, const sim::NavMesh& barred) {
  const auto open_m = open.Geodesic(passage.a_world, passage.b_world);
  const auto around_m = barred.Geodesic(passage.a_world, passage.b_world);
  return open_m && (!around_m || *around_m > *open_m + kAround_m);
}

/// Whether a door may shut these rooms: a single room, a small part of the house, without changes.
bool MayBeShut(const std::vector<int>& rooms, const HouseView& view, const DayChanges& list) {
  if (rooms.empty()) return true;
  if (rooms.size() > 1) return false;
  const RoomView& room = view.rooms[static_cast<std::size_t>(rooms.front())];
  double area_m2 = 0;
  for (const RoomView& other : view.rooms) area_m2 += other.AreaM2();
  if (room.AreaM2() > kShutShare * area_m2) return false;
  return std::none_of(list.changes.begin(), list.changes.end(), [&](const Change& change) {
    return change.to && change.to->room == room.region && change.to->floor == room.floor;
  });
}

Box3 BoxOf(const Board& board, double height_m) {
  const Vector3d side(0.5 * board.length_m * std::cos(board.yaw_rad),
                      0.5 * board.length_m * std::sin(board.yaw_rad), 0);
  Box3 box;
  box.Add(board.centre_world - side);
  box.Add(board.centre_world + side + Vector3d(0, 0, height_m));
  box.Add(board.centre_world + side);
  return box;
}

/// A passage that may be barred, and the room that this cuts off, if any.
struct BarWish {
  std::size_t passage = 0;
  std::vector<int> shut;
};

/// Passages with a detour first; a flight without a detour is never barred.
std::vector<BarWish> BarWishes(const std::vector<Passage>& passages, const ChangeWish& wish,
                               const DayChanges& list, Rng& rng) {
  std::vector<BarWish> wishes;
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const bool is_free = !ChangedOf(list).contains(passages[i].leaf);
    if (!is_free || !IsOfKind(passages[i], wish.kind)) continue;
    BarWish bar{i, CutOffWithout(passages, i, wish.evening)};
    if (passages[i].is_flight ? bar.shut.empty() : MayBeShut(bar.shut, wish.evening, list)) {
      wishes.push_back(std::move(bar));
    }
  }
  rng.Shuffle(wishes);
  std::stable_sort(wishes.begin(), wishes.end(),
                   [](const auto& a, const auto& b) { return a.shut.size() < b.shut.size(); });
  if (wishes.size() > kBarTries) wishes.resize(kBarTries);
  return wishes;
}

void NoteBar(const ChangeWish& wish, const Passage& passage, const BarWish& bar, int id,
             HouseDay& day) {
  const int index = bar.shut.empty() ? passage.room_a : bar.shut.front();
  const RoomView& room = wish.evening.rooms[static_cast<std::size_t>(index)];
  Change change = ChangeOf(wish.kind, *day.scene.FindInstance(id));
  change.to = ChangePlace{passage.board.centre_world, BoxOf(passage.board, kBarrierHeight_m),
                          room.region, room.floor, 0};
  SetRegion(day.scene, id, room.region);
  for (const int shut : bar.shut) {
    const RoomView& behind = wish.evening.rooms[static_cast<std::size_t>(shut)];
    day.shut.emplace(behind.floor, behind.region);
  }
  day.list.changes.push_back(std::move(change));
}

Result<bool> BarWay(const ChangeWish& wish, HouseDay& day, Rng& rng) {
  const sim::RayCaster caster(day.scene);
  const auto passages = PassagesOf(day.scene, caster, wish.evening);
  for (const BarWish& bar : BarWishes(passages, wish, day.list, rng)) {
    const Passage& passage = passages[bar.passage];
    sim::Scene barred = day.scene;
    const int id = Bar(passage, wish.kind, barred);
    const auto navmesh = sim::NavMesh::Build(barred, wish.navmesh);
    if (!navmesh) return tl::unexpected(navmesh.error());
    const bool has_way = navmesh->Geodesic(passage.a_world, passage.b_world).has_value();
    if (!IsBarred(passage, *wish.evening.navmesh, *navmesh)) continue;
    if (!has_way && bar.shut.empty()) continue;
    day.scene = std::move(barred);
    NoteBar(wish, passage, bar, id, day);
    return true;
  }
  return false;
}

/// Triangles of `id` in `from`, added to `to` under the same id.
void CopyTriangles(const sim::Scene& from, int id, sim::Scene& to) {
  const sim::TriangleMesh& mesh = from.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] != id) continue;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      corners[k] = static_cast<std::uint32_t>(to.mesh.vertices.size());
      to.mesh.vertices.push_back(mesh.vertices[v]);
      if (!mesh.uvs.empty()) to.mesh.uvs.push_back(mesh.uvs[v]);
      if (!mesh.vertex_colours.empty()) to.mesh.vertex_colours.push_back(mesh.vertex_colours[v]);
    }
    to.mesh.triangles.push_back(corners);
    to.mesh.triangle_material.push_back(mesh.triangle_material[t]);
    to.mesh.triangle_instance.push_back(id);
  }
}

}  // namespace

Result<bool> ChangeOnce(const ChangeWish& wish, HouseDay& day, Rng& rng) {
  if (wish.kind >= ChangeKind::kDoorClosed) return BarWay(wish, day, rng);
  return ChangeObject(wish, day, rng);
}

sim::Scene WithoutBars(const sim::Scene& scene, const sim::Scene& evening, const DayChanges& list) {
  sim::Scene open = scene;
  for (const Change& change : list.changes) {
    if (change.kind < ChangeKind::kDoorClosed) continue;
    if (change.kind != ChangeKind::kDoorClosed) {
      RemoveInstance(open, change.instance);
      continue;
    }
    RemoveTriangles(open, change.instance, [](const Vector3d&) { return true; });
    CopyTriangles(evening, change.instance, open);
  }
  Settle(open);
  return open;
}

}  // namespace crossnav::world
