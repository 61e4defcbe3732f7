// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furnish.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "crossnav/world/furniture/groups.h"
#include "crossnav/world/furniture/room_rules.h"
#include "crossnav/world/furniture/room_space.h"

namespace crossnav::world {
namespace {

using std::numbers::pi;
constexpr int kPieceTries = 40;  // chosen: per piece

/// Rugs lie under everything.
bool IsFlat(const Box3& b) {
  return b.max.z() - b.min.z() < 0.02;
}

bool Inside(const Rect& in, const Rect& out) {
  return in.x0 >= out.x0 - 0.02 && in.x1 <= out.x1 + 0.02 && in.y0 >= out.y0 - 0.02 &&
         in.y1 <= out.y1 + 0.02;
}

/// A side of a rectangle: origin and direction along it, front into the room.
struct Side {
  Vector2d start, along;
  double length_m, yaw_rad;
};

std::array<Side, 4> SidesOf(const Rect& r) {
  return {Side{{r.x1, r.y1}, {-1, 0}, r.Width(), pi}, Side{{r.x0, r.y0}, {1, 0}, r.Width(), 0},
          Side{{r.x0, r.y1}, {0, -1}, r.Depth(), -pi / 2},
          Side{{r.x1, r.y0}, {0, 1}, r.Depth(), pi / 2}};
}

class RoomFiller {
 public:
  RoomFiller(HousePlan& plan, int room, const FurnitureSource& source, Rng& rng)
      : plan_(plan),
        index_(room),
        room_(plan.rooms[static_cast<std::size_t>(room)]),
        source_(source),
        rng_(rng) {
    RoomSpace space = SpaceOf(plan, room);
    floor_m_ = space.floor_m;
    ceiling_m_ = space.ceiling_m;
    inner_ = space.inner;
    keep_out_ = std::move(space.keep_out);
    keep_out_.insert(keep_out_.end(), plan.taken.begin(), plan.taken.end());
  }

  void Fill(const std::function<bool(std::string_view)>& wants) {
    for (const Rule& rule : RulesOf(room_.type)) {
      if (!wants(rule.kind)) continue;
      if (room_.rects[0].Area() < rule.min_area_m2) continue;
      for (int i = 0; i < rule.most; ++i) {
        if (!rng_.Chance(rule.chance)) continue;
        // Tries another size if the first does not fit.
        bool is_done = false;
        for (double share : {1.0, 0.8, 0.6, 0.5}) is_done = is_done || Try(rule, share);
      }
    }
    AddClutter();
  }

 private:
  bool HasWallBehind(const Vector2d& p, double yaw_rad) const {
    const Vector2d back(std::sin(yaw_rad), -std::cos(yaw_rad));  // -y of the group
    const Vector2d q = p + 0.1 * back;
    return std::any_of(plan_.walls.begin(), plan_.walls.end(), [&](const Wall& w) {
      if (w.level != room_.level) return false;
      const Rect r{std::min(w.a.x(), w.b.x()), std::min(w.a.y(), w.b.y()),
                   std::max(w.a.x(), w.b.x()), std::max(w.a.y(), w.b.y())};
      return r.Grown(0.13).Contains(q);
    });
  }

  Rect RectAt(const Pose& T, const Rect& r) const {
    const Vector3d a = T * Vector3d(r.x0, r.y0, 0), b = T * Vector3d(r.x1, r.y1, 0);
    return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
            std::max(a.y(), b.y())};
  }

  bool Fits(const Group& group, const Pose& T, const Rect& front) const {
    if (!Inside(RectAt(T, group.body), inner_)) return false;
    if (front.Area() > 1e-6 && !Inside(front, inner_)) return false;
    const Box3 walkway = Solid(front, floor_m_ + 0.05, floor_m_ + 1.2);
    for (const Box3& b : bodies_) {
      if (front.Area() > 1e-6 && Overlap(walkway, b)) return false;
    }
    for (const auto& item : group.items) {
      const Box3 box = BoxAt(item.model, T * item.T_group_object);
      if (box.max.z() > ceiling_m_ + 1e-6) return false;
      if (!item.is_optional && !IsFlat(box) && IsTaken(box)) return false;
    }
    return true;
  }

  bool IsTaken(const Box3& box) const {
    const auto hits = [&](const Box3& b) { return Overlap(box, b); };
    return std::any_of(keep_out_.begin(), keep_out_.end(), hits) ||
           std::any_of(bodies_.begin(), bodies_.end(), hits) ||
           std::any_of(fronts_.begin(), fronts_.end(), hits);
  }

  void Put(Group group, const Pose& T, const Rect& front) {
    for (auto& item : group.items) {
      const Pose T_world = T * item.T_group_object;
      const Box3 box = BoxAt(item.model, T_world);
      if (item.is_optional && IsTaken(box)) continue;
      if (!IsFlat(box)) bodies_.push_back(box);
      plan_.furniture.push_back({std::move(item.model), T_world, index_});
    }
    if (front.Area() > 1e-6) fronts_.push_back(Solid(front, floor_m_ + 0.05, floor_m_ + 1.2));
  }

  Pose PoseAt(const Vector2d& p, double yaw_rad, double z_m) const {
    return StandAt({p.x(), p.y(), floor_m_ + z_m}, yaw_rad);
  }

  bool TryAt(Group& group, const Vector2d& p, double yaw_rad, double z_m) {
    const Pose T = PoseAt(p, yaw_rad, z_m);
    const Rect front = RectAt(
        T, {group.body.x0, group.body.y1, group.body.x1, group.body.y1 + group.clear_front_m});
    if (!Fits(group, T, front)) return false;
    Put(std::move(group), T, front);
    return true;
  }

  /// Places a piece within `share` of the longest wall.
  bool Try(const Rule& rule, double share) {
    const double space = share * std::max(inner_.Width(), inner_.Depth());
    auto group = MakeGroup(rule.kind, source_, space, rng_);
    if (!group) return false;
    switch (rule.where) {
      case Where::kMiddle:
        return TryMiddle(*group);
      case Where::kCorner:
        return TryCorner(*group);
      case Where::kFacingTv:
        return TryFacing(*group) || TryWall(*group, 0);
      case Where::kOnWall:
        return TryWall(*group, rule.kind == "mirror" ? 0.95 : rng_.Uniform(1.3, 1.45));
      case Where::kCeiling:
        return TryCeiling(*group);
      case Where::kWall:
        break;
    }
    const bool done = TryWall(*group, 0);
    if (done && rule.kind == "tv group") tv_ = plan_.furniture.back().T_world_object;
    return done;
  }

  bool TryWall(Group& group, double z_m) {
    const auto sides = SidesOf(inner_);
    const double half = 0.5 * group.body.Width();
    for (int attempt = 0; attempt < kPieceTries; ++attempt) {
      const Side& side = sides[rng_.Below(4)];
      if (side.length_m < 2 * half) continue;
      double t = rng_.Uniform(half, std::max(half + 1e-9, side.length_m - half));
      if (rng_.Chance(0.3)) t = rng_.Chance(0.5) ? half : side.length_m - half;
      const Vector2d p = side.start + t * side.along;
      if (!HasWallBehind(p, side.yaw_rad)) continue;
      if (TryAt(group, p, side.yaw_rad, z_m)) return true;
    }
    return false;
  }

  bool TryCorner(Group& group) {
    const auto sides = SidesOf(inner_);
    const double half = 0.5 * group.body.Width() + 0.03;
    for (int attempt = 0; attempt < 12; ++attempt) {
      const Side& side = sides[rng_.Below(4)];
      if (side.length_m < 2 * half) continue;
      const double t = rng_.Chance(0.5) ? half : side.length_m - half;
      const Vector2d p = side.start + t * side.along;
      if (!HasWallBehind(p, side.yaw_rad)) continue;
      if (TryAt(group, p, side.yaw_rad, 0)) return true;
    }
    return false;
  }

  bool TryMiddle(Group& group) {
    for (int attempt = 0; attempt < kPieceTries; ++attempt) {
      const double yaw = rng_.Below(4) * pi / 2;
      const Vector2d p = inner_.Draw(rng_);
      const Pose T = PoseAt(p, yaw, 0);
      const Rect around = RectAt(T, group.body).Grown(0.55);
      if (!Fits(group, T, around)) continue;
      Put(std::move(group), T, around);
      return true;
    }
    return false;
  }

  /// Opposite the television, at the largest distance that the room allows.
  bool TryFacing(Group& group) {
    if (!tv_) return false;
    const Vector3d ahead = tv_->linear() * Vector3d::UnitY();
    const double yaw = std::atan2(ahead.x(), -ahead.y());  // faces it
    const Vector2d from = tv_->translation().head<2>(), n = ahead.head<2>();
    for (double d = 6.0; d > 1.8; d -= 0.1) {
      for (double aside : {0.0, 0.3, -0.3, 0.6, -0.6}) {
        const Vector2d p = from + d * n + aside * Vector2d(-n.y(), n.x());
        if (TryAt(group, p, yaw, 0)) return true;
      }
    }
    return false;
  }

  bool TryCeiling(Group& group) {
    const Vector2d c = inner_.Center();
    if (!room_.has_ceiling) return true;
    for (const Rect& v : plan_.VoidsOf(room_.level + 1)) {
      if (v.Grown(0.4).Contains(c)) return true;
    }
    ObjectModel& lamp = group.items[0].model;
    const Pose T = StandAt({c.x(), c.y(), ceiling_m_}, 0);
    const Box3 box = BoxAt(lamp, T);
    for (const Box3& b : bodies_) {
      if (Overlap(box, b)) return true;
    }
    bodies_.push_back(box);
    plan_.furniture.push_back({std::move(lamp), T, index_});
    return true;
  }

  /// Tops on which people put things: neither a bath nor the top of a wardrobe.
  static bool IsShelf(const ObjectModel& model) {
    constexpr double kLow_m = 0.3, kHigh_m = 1.3;  // chosen: within reach
    return model.top_m >= kLow_m && model.top_m <= kHigh_m && model.name != "bathtub" &&
           model.name != "toilet" && model.name != "shower";
  }

  /// Small objects on free tops.
  void AddClutter() {
    static constexpr std::string_view kSmall[] = {"vase", "book", "bowl", "table lamp", "book"};
    const std::size_t count = plan_.furniture.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ObjectModel& below = plan_.furniture[i].model;
      if (plan_.furniture[i].room != index_ || !IsShelf(below) || !rng_.Chance(0.6)) continue;
      const Vector3d size = below.Size();
      auto model = source_.Make(kSmall[rng_.Below(std::size(kSmall))], rng_);
      Pose T = plan_.furniture[i].T_world_object;
      const double off_y = rng_.Uniform(-0.25, 0.25), off_x = rng_.Uniform(-0.3, 0.3);
      T.translate(Vector3d(off_x * size.x(), off_y * size.y(), below.top_m));
      const Box3 box = BoxAt(*model, T);
      const bool is_free = std::none_of(bodies_.begin(), bodies_.end(), [&](const Box3& b) {
        const Vector3d shared = box.max.cwiseMin(b.max) - box.min.cwiseMax(b.min);
        return shared.minCoeff() > 1e-3;
      });
      if (!is_free) continue;
      bodies_.push_back(box);
      plan_.furniture.push_back({std::move(*model), T, index_});
    }
  }

  HousePlan& plan_;
  int index_;
  const Room room_;
  const FurnitureSource& source_;
  Rng& rng_;
  double floor_m_ = 0, ceiling_m_ = 0;
  Rect inner_;
  std::vector<Box3> bodies_, keep_out_, fronts_;
  std::optional<Pose> tv_;
};

}  // namespace

void Furnish(HousePlan& plan, const FurnitureSource& source, Rng& rng) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    FurnishRoom(plan, static_cast<int>(i), source, rng, [](std::string_view) { return true; });
  }
}

void FurnishRoom(HousePlan& plan, int room, const FurnitureSource& source, Rng& rng,
                 const std::function<bool(std::string_view)>& wants) {
  RoomFiller(plan, room, source, rng).Fill(wants);
}

}  // namespace crossnav::world
