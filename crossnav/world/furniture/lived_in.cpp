// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/lived_in.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/world/furniture/room_space.h"

namespace crossnav::world {
namespace {

using std::numbers::pi;

/// A room with its furniture.
class Dweller {
 public:
  Dweller(HousePlan& plan, int room, const FurnitureSource& source, Rng& rng)
      : plan_(plan), room_(room), space_(SpaceOf(plan, room)), source_(source), rng_(rng) {
    for (const Placement& p : plan.furniture) {
      if (p.room == room) bodies_.push_back(BoxAt(p.model, p.T_world_object));
    }
  }

  void Litter() {
    static constexpr std::string_view kThings[] = {"book",  "box",       "basket", "bowl", "vase",
                                                   "stool", "trash can", "book",   "box"};
    const Rect& in = space_.inner;
    const int count = rng_.Int(1, 2 + static_cast<int>(in.Area() / 5));
    for (int i = 0; i < count; ++i) {
      const auto model = source_.Make(kThings[rng_.Below(std::size(kThings))], rng_);
      const Vector2d at = in.Draw(rng_);
      const Vector3d p(at.x(), at.y(), space_.floor_m);
      const double yaw_rad = rng_.Uniform(0, 2 * pi);
      if (model) TryPut(*model, StandAt(p, yaw_rad));
    }
  }

  void AddSmallPlants(double chance) {
    constexpr double kLow_m = 0.3, kHigh_m = 1.3;  // chosen: tops within reach
    const std::size_t count = plan_.furniture.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Placement& below = plan_.furniture[i];
      const double top_m = below.model.top_m;
      const bool is_basin = below.model.name == "bathtub" || below.model.name == "toilet" ||
                            below.model.name == "shower" || below.model.name == "washbasin";
      if (below.room != room_ || top_m < kLow_m || top_m > kHigh_m || is_basin) continue;
      if (!rng_.Chance(chance)) continue;
      auto plant = source_.Make("potted plant", rng_);
      if (!plant) continue;
      Scale(*plant, rng_.Uniform(0.2, 0.4) / plant->Size().z());
      Pose T = below.T_world_object;
      const Vector3d size = below.model.Size();
      const double off_y = rng_.Uniform(-0.25, 0.25), off_x = rng_.Uniform(-0.3, 0.3);
      T.translate(Vector3d(off_x * size.x(), off_y * size.y(), top_m + 0.001));
      TryPut(*plant, T);
    }
  }

  void HideGoals(double chance) {
    const auto& categories = sim::DefaultCategories();
    const std::size_t count = plan_.furniture.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Placement& goal = plan_.furniture[i];
      const auto category = categories.find(goal.model.name);
      if (goal.room != room_ || category == categories.end() || category->second.empty()) continue;
      if (rng_.Chance(chance)) HideOne(i);
    }
  }

  /// Goal objects and their look-alikes, several of a kind, where no rule of a room puts them.
  void AddOddPieces() {
    static constexpr std::string_view kPieces[] = {
        "armchair",     "armchair",     "armchair",     "couch",
        "couch",        "chair",        "chair",        "dining chair",
        "dining chair", "office chair", "potted plant", "potted plant",
        "tv",           "tv unit",      "tv",           "bed",
        "bunk bed",     "loft bed",     "toilet",       "stool",
        "stool",        "bench",        "ottoman",      "desk",
        "bookcase",     "coffee table", "dining table", "computer monitor"};
    const int count = rng_.Int(3, 4 + static_cast<int>(space_.inner.Area() / 2));
    for (int i = 0; i < count; ++i) {
      const std::string_view kind = kPieces[rng_.Below(std::size(kPieces))];
      const auto model = source_.Make(kind, rng_);
      if (!model) continue;
      const bool is_light = kind == "potted plant" || kind == "tv" || kind == "computer monitor";
      const Pose T = is_light && rng_.Chance(0.5) ? OnWall(*model) : Anywhere();
      if (TryPut(*model, T) && rng_.Chance(0.3)) AddRow(*model, T);
    }
  }

 private:
  Pose Anywhere() {
    const Vector2d p = space_.inner.Draw(rng_);
    return StandAt({p.x(), p.y(), space_.floor_m}, rng_.Uniform(0, 2 * pi));
  }

  /// As on a sill or a board, the back to one of the four walls.
  Pose OnWall(const ObjectModel& model) {
    const Rect& in = space_.inner;
    const double yaw_rad = 0.5 * pi * rng_.Int(0, 3);
    const Vector2d front(-std::sin(yaw_rad), std::cos(yaw_rad));
    const double depth_m = 0.5 * model.Size().y() + 0.005;
    Vector2d p = in.Draw(rng_);
    if (front.x() > 0.5) p.x() = in.x0 + depth_m;
    if (front.x() < -0.5) p.x() = in.x1 - depth_m;
    if (front.y() > 0.5) p.y() = in.y0 + depth_m;
    if (front.y() < -0.5) p.y() = in.y1 - depth_m;
    return StandAt({p.x(), p.y(), space_.floor_m + rng_.Uniform(0.3, 1.6)}, yaw_rad);
  }

  /// Up to four more of the same beside the first.
  void AddRow(const ObjectModel& model, Pose T) {
    const double step_m = model.Size().x() + rng_.Uniform(0.03, 0.3);
    const int count = rng_.Int(1, 4);
    for (int i = 0; i < count; ++i) {
      T.translate(Vector3d(step_m, 0, 0));
      if (!TryPut(model, T)) return;
    }
  }

  static void Scale(ObjectModel& model, double factor) {
    for (auto& v : model.mesh.vertices) v *= static_cast<float>(factor);
    model.top_m = -1;
  }

  /// Places an object on the floor close before the goal object, or beside it.
  void HideOne(std::size_t index) {
    static constexpr std::string_view kBefore[] = {"box", "basket", "stool", "ottoman",
                                                   "chest of drawers"};
    const Box3 goal = BoxAt(plan_.furniture[index].model, plan_.furniture[index].T_world_object);
    if (goal.min.z() > space_.floor_m + 0.1) return;
    const auto model = source_.Make(kBefore[rng_.Below(std::size(kBefore))], rng_);
    const int first = rng_.Int(0, 3);
    if (!model) return;
    const Vector3d half = 0.5 * (model->Size() + (goal.max - goal.min));
    for (int side = 0; side < 4; ++side) {
      const double yaw_rad = 0.5 * pi * ((first + side) % 4);
      const Vector3d way(std::sin(yaw_rad), -std::cos(yaw_rad), 0);
      const double reach_m =
          std::abs(way.x()) * half.x() + std::abs(way.y()) * half.y() + rng_.Uniform(0.05, 0.25);
      const Vector3d p(goal.Center().x() + reach_m * way.x(), goal.Center().y() + reach_m * way.y(),
                       space_.floor_m);
      if (TryPut(*model, StandAt(p, 0))) return;
    }
  }

  bool TryPut(const ObjectModel& model, const Pose& T_world) {
    const Box3 box = BoxAt(model, T_world);
    const Rect& in = space_.inner;
    const bool is_inside = box.min.x() >= in.x0 && box.max.x() <= in.x1 && box.min.y() >= in.y0 &&
                           box.max.y() <= in.y1 && box.max.z() <= space_.ceiling_m;
    const auto meets = [&](const Box3& b) {
      return (box.max.cwiseMin(b.max) - box.min.cwiseMax(b.min)).minCoeff() > 1e-4;
    };
    if (!is_inside || std::any_of(bodies_.begin(), bodies_.end(), meets) ||
        std::any_of(space_.keep_out.begin(), space_.keep_out.end(), meets)) {
      return false;
    }
    bodies_.push_back(box);
    plan_.furniture.push_back({model, T_world, room_});
    return true;
  }

  HousePlan& plan_;
  int room_;
  RoomSpace space_;
  const FurnitureSource& source_;
  Rng& rng_;
  std::vector<Box3> bodies_;
};

}  // namespace

void LiveIn(HousePlan& plan, const LivedIn& chances, const FurnitureSource& source, Rng& rng) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    if (plan.rooms[i].type == RoomType::kVoid) continue;
    Dweller dweller(plan, static_cast<int>(i), source, rng);
    dweller.HideGoals(chances.hidden_goal_chance);
    dweller.AddSmallPlants(chances.small_goal_chance);
    if (rng.Chance(chances.clutter_chance)) dweller.Litter();
    if (chances.has_odd_pieces) dweller.AddOddPieces();
  }
}

}  // namespace crossnav::world
