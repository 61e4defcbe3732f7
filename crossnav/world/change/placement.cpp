// SPDX-License-Identifier: MIT
#include "crossnav/world/change/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "crossnav/world/change/free_space.h"
#include "crossnav/world/change/object_words.h"

namespace crossnav::world {
namespace {

constexpr int kPlaceTries = 60;          // chosen: draws of a place in a room
constexpr double kLong_m = 0.9;          // chosen: longer objects stay at a wall, or at their place
constexpr double kWallReach_m = 2.5;     // chosen: a wall further away is another wall's
constexpr double kOffSkirting_m = 0.05;  // chosen: skirting and cables
constexpr double kMovedOnTop_m = 0.25;   // chosen: further than a hand pushes a thing aside
constexpr double kMovedBeside_m = 0.5;   // chosen: another side of a table
constexpr double kMovedAway_m = 1.0;     // chosen: outside the success radius of its old place
constexpr double kLowestTop_m = 0.25, kHighestTop_m = 1.4;  // chosen: above the ground
constexpr double kLoungeArea_m2 = 5;                        // chosen: smaller rooms hold no sofa

const std::array<Vector3d, 4> kSides = {Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitX(),
                                        -Vector3d::UnitY()};

/// Box of an instance's vertices after a shift.
Box3 BoxAfter(const sim::Scene& scene, int id, const Shift& shift) {
  Box3 box;
  const sim::TriangleMesh& mesh = scene.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] != id) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      box.Add(shift.Of(mesh.vertices[v].cast<double>()));
    }
  }
  return box;
}

Box3 Shifted(Box3 box, const Vector3d& by) {
  box.min += by;
  box.max += by;
  return box;
}

Vector3d FootOf(const Box3& box) {
  return {box.Center().x(), box.Center().y(), box.min.z()};
}

/// Draws places for one object.
class Placer {
 public:
  Placer(const Night& night, const sim::SceneInstance& object, ChangeKind kind, Rng& rng)
      : night_(night),
        object_(object),
        kind_(kind),
        rng_(rng),
        caster_(*night.caster),
        was_(night.view.objects.at(object.id)),
        foot_(FootOf(object.box)) {
    for (int turn = 0; turn < 4; ++turn) {
      turns_[static_cast<std::size_t>(turn)] = BoxAfter(night.scene, object.id, TurnBy(turn));
    }
    const Vector3d size = object.box.max - object.box.min;
    is_long_ = std::max(size.x(), size.y()) > kLong_m;
    if (is_long_) back_ = BackOf();
  }

  std::optional<Standing> Find() { return was_.is_on_ground ? FindOnGround() : FindOnTop(); }

 private:
  Shift TurnBy(int quarter_turns) const {
    return {foot_, quarter_turns * std::numbers::pi / 2, Vector3d::Zero()};
  }

  /// Free distance from a side of `box` at half its height, without the object itself.
  double FreeFrom(const Box3& box, int side, double max_m, int* instance = nullptr) const {
    const Vector3d& out = kSides[static_cast<std::size_t>(side)];
    Vector3d from = box.Center();
    from.z() = box.min.z() + 0.5 * std::min(1.0, box.max.z() - box.min.z());
    const Vector3d half = 0.5 * (box.max - box.min);
    const double inside_m = std::abs(out.x()) * half.x() + std::abs(out.y()) * half.y();
    const double free_m = FreeLength(caster_, from, out, object_.id, inside_m + max_m);
    if (instance != nullptr) {
      const auto hit = caster_.Cast(from + (free_m - 0.02) * out, out, 0.05);
      *instance = hit ? hit->instance : 0;
    }
    return free_m - inside_m;
  }

  /// Side at which the nearest wall is.
  std::optional<int> WallSide(const Box3& box, double max_m) const {
    std::optional<int> best;
    double nearest_m = max_m;
    for (int side = 0; side < 4; ++side) {
      int instance = 0;
      const double free_m = FreeFrom(box, side, max_m, &instance);
      const auto* wall = instance > 0 ? night_.scene.FindInstance(instance) : nullptr;
      if (wall == nullptr || !IsWall(wall->name) || free_m >= nearest_m) continue;
      nearest_m = free_m;
      best = side;
    }
    return best;
  }

  std::optional<int> BackOf() const {
    return WallSide(object_.box, 0.4);  // chosen: else it stands free in its room
  }

  /// Rooms permitted by the kind of change and suitable for the object.
  std::vector<int> RoomsAsked() const {
    std::vector<int> rooms;
    for (int i = 0; i < static_cast<int>(night_.view.rooms.size()); ++i) {
      if (IsAsked(i) && Suits(night_.view.rooms[static_cast<std::size_t>(i)])) rooms.push_back(i);
    }
    return rooms;
  }

  bool IsAsked(int room) const {
    const auto floor = [&](int i) { return night_.view.rooms[static_cast<std::size_t>(i)].floor; };
    switch (kind_) {
      case ChangeKind::kOtherRoom:
        return room != was_.room && floor(room) == floor(was_.room);
      case ChangeKind::kOtherFloor:
        return floor(room) != floor(was_.room);
      case ChangeKind::kAdded:
        return true;
      default:
        return room == was_.room;
    }
  }

  bool Suits(const RoomView& room) const {
    if (room.ground.empty()) return false;
    const bool is_lounge =
        object_.category == "sofa" || object_.category == "tv_monitor" || is_long_;
    if (is_lounge && (room.is_bath || room.is_kitchen || room.AreaM2() < kLoungeArea_m2)) {
      return false;
    }
    return !(room.is_bath && object_.category == "chair");
  }

  /// Whether the surroundings agree with the requested kind of change.
  bool IsOfKind(const Box3& box, int beside) const {
    const double moved_m = (FootOf(box) - foot_).head<2>().norm();
    switch (kind_) {
      case ChangeKind::kSameFurniture:
        return was_.is_on_ground
                   ? was_.landmark != 0 && beside == was_.landmark && moved_m > kMovedBeside_m
                   : beside == was_.support && moved_m > kMovedOnTop_m;
      case ChangeKind::kOtherFurniture:
        return beside != 0 && beside != (was_.is_on_ground ? was_.landmark : was_.support) &&
               moved_m > kMovedAway_m;
      default:
        return moved_m > kMovedAway_m || std::abs(FootOf(box).z() - foot_.z()) > 1;
    }
  }

  Standing StandingAt(int turn, const Vector3d& p_world, int room, int beside) const {
    Standing standing;
    standing.shift = TurnBy(turn);
    const Box3& turned = turns_[static_cast<std::size_t>(turn)];
    standing.shift.by_world = p_world - FootOf(turned);
    standing.place.box = Shifted(turned, standing.shift.by_world);
    standing.place.p_world = FootOf(standing.place.box);
    standing.place.room = night_.view.rooms[static_cast<std::size_t>(room)].region;
    standing.place.floor = night_.view.rooms[static_cast<std::size_t>(room)].floor;
    standing.place.support = beside;
    return standing;
  }

  bool IsChanged(int instance) const { return night_.changed.contains(instance); }

  /// Backs an object to the nearest wall if it stood so before: turn and shift towards the wall.
  std::optional<std::pair<int, Vector3d>> AgainstWall(Vector3d p_world) const {
    Box3 probe;  // a thin post, to find the wall from the middle of the place
    probe.Add(p_world + Vector3d(-0.01, -0.01, 0));
    probe.Add(p_world + Vector3d(0.01, 0.01, 0.8));
    const auto wall = WallSide(probe, kWallReach_m);
    if (!wall) return std::nullopt;
    const int turn = (*wall - *back_ + 4) % 4;
    const Vector3d half = 0.5 * (turns_[static_cast<std::size_t>(turn)].max -
                                 turns_[static_cast<std::size_t>(turn)].min);
    const Vector3d& out = kSides[static_cast<std::size_t>(*wall)];
    const double deep_m = std::abs(out.x()) * half.x() + std::abs(out.y()) * half.y();
    const double to_wall_m = FreeFrom(probe, *wall, kWallReach_m) + 0.01;
    p_world += out * (to_wall_m - deep_m - kOffSkirting_m);
    return std::make_pair(turn, p_world);
  }

  std::optional<Standing> FindOnGround() {
    const auto rooms = RoomsAsked();
    if (rooms.empty()) return std::nullopt;
    for (int i = 0; i < kPlaceTries; ++i) {
      const int room = rooms[rng_.Below(static_cast<std::uint32_t>(rooms.size()))];
      const auto& ground = night_.view.rooms[static_cast<std::size_t>(room)].ground;
      Vector3d p = ground[rng_.Below(static_cast<std::uint32_t>(ground.size()))];
      int turn = rng_.Int(0, 3);
      if (back_) {
        const auto against = AgainstWall(p);
        if (!against) continue;
        std::tie(turn, p) = *against;
      }
      if (auto standing = TryGround(turn, p, room)) return standing;
    }
    return std::nullopt;
  }

  std::optional<Standing> TryGround(int turn, Vector3d p, int room) const {
    const auto below = SurfaceBelow(caster_, p + Vector3d(0, 0, 0.3), object_.id, 0.6);
    const auto* ground = below ? night_.scene.FindInstance(below->instance) : nullptr;
    if (ground == nullptr || !IsGround(ground->name)) return std::nullopt;
    p.z() = below->p_world.z();
    const Box3 box = Shifted(turns_[static_cast<std::size_t>(turn)],
                             p - FootOf(turns_[static_cast<std::size_t>(turn)]));
    const int beside = LandmarkBeside(night_.scene, box, object_.id);
    if (IsChanged(beside) || !IsOfKind(box, beside)) return std::nullopt;
    const auto may_carry = [&](int id) {
      const auto* instance = id > 0 ? night_.scene.FindInstance(id) : nullptr;
      return instance != nullptr && IsGround(instance->name);
    };
    if (!IsFree(caster_, {box, Hidden(), may_carry})) return std::nullopt;
    return StandingAt(turn, p, room, beside);
  }

  std::optional<Standing> FindOnTop() {
    std::vector<const sim::SceneInstance*> tops;
    for (const sim::SceneInstance& top : night_.scene.instances) {
      const auto known = night_.view.objects.find(top.id);
      if (known == night_.view.objects.end() || known->second.room < 0) continue;
      if (!HasTop(top.name) || !known->second.is_on_ground || IsChanged(top.id)) continue;
      if (kind_ == ChangeKind::kSameFurniture && top.id != was_.support) continue;
      const int room = known->second.room;
      if (IsAsked(room) && Suits(night_.view.rooms[static_cast<std::size_t>(room)])) {
        tops.push_back(&top);
      }
    }
    if (tops.empty()) return std::nullopt;
    for (int i = 0; i < kPlaceTries; ++i) {
      const auto& top = *tops[rng_.Below(static_cast<std::uint32_t>(tops.size()))];
      if (auto standing = TryTop(top)) return standing;
    }
    return std::nullopt;
  }

  std::optional<Standing> TryTop(const sim::SceneInstance& top) {
    const int turn = rng_.Int(0, 3);
    Vector3d p = top.box.max;
    for (const int axis : {1, 0}) p[axis] = rng_.Uniform(top.box.min[axis], top.box.max[axis]);
    const auto below = SurfaceBelow(caster_, p + Vector3d(0, 0, 0.02), object_.id, 1.5);
    if (!below || below->instance != top.id) return std::nullopt;
    p.z() = below->p_world.z();
    const double above_m = p.z() - top.box.min.z();
    if (above_m < kLowestTop_m || above_m > kHighestTop_m) return std::nullopt;
    const Box3 box = Shifted(turns_[static_cast<std::size_t>(turn)],
                             p - FootOf(turns_[static_cast<std::size_t>(turn)]));
    if (!IsOfKind(box, top.id)) return std::nullopt;
    const auto may_carry = [&](int id) { return id == top.id; };
    if (!IsFree(caster_, {box, Hidden(), may_carry})) return std::nullopt;
    return StandingAt(turn, p, night_.view.objects.at(top.id).room, top.id);
  }

  /// The object is no obstacle to its own move, but to its copy.
  int Hidden() const { return kind_ == ChangeKind::kAdded ? 0 : object_.id; }

  const Night& night_;
  const sim::SceneInstance& object_;
  ChangeKind kind_;
  Rng& rng_;
  const sim::RayCaster& caster_;
  const ObjectView& was_;
  Vector3d foot_;
  std::array<Box3, 4> turns_;  // its box after quarter turns about its foot
  bool is_long_ = false;
  std::optional<int> back_;  // side that has a wall behind it
};

}  // namespace

ChangePlace PlaceOf(const HouseView& view, const sim::SceneInstance& object) {
  ChangePlace place;
  place.box = object.box;
  place.p_world = FootOf(object.box);
  const auto known = view.objects.find(object.id);
  if (known == view.objects.end()) return place;
  if (known->second.room >= 0) {
    place.room = view.rooms[static_cast<std::size_t>(known->second.room)].region;
    place.floor = view.rooms[static_cast<std::size_t>(known->second.room)].floor;
  }
  place.support = known->second.is_on_ground ? known->second.landmark : known->second.support;
  return place;
}

bool MayMove(const HouseView& view, const sim::SceneInstance& object) {
  if (object.box.empty() || !IsMovable(object.name, object.category)) return false;
  const auto known = view.objects.find(object.id);
  return known != view.objects.end() && known->second.room >= 0 && known->second.support > 0 &&
         !known->second.is_carrier;
}

std::optional<Standing> FindPlace(const Night& night, const sim::SceneInstance& object,
                                  ChangeKind kind, Rng& rng) {
  return Placer(night, object, kind, rng).Find();
}

}  // namespace crossnav::world
