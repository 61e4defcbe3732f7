// SPDX-License-Identifier: MIT
#include "crossnav/homes/furnish_home.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "crossnav/homes/building_words.h"
#include "crossnav/homes/furnish_map.h"
#include "crossnav/homes/shell.h"
#include "crossnav/world/furniture/furnish.h"

namespace crossnav::homes {
namespace {

using world::Rect;

constexpr double kMargin_m = 1.0;      // chosen: around a room, to see its entrances
constexpr double kToWall_m = 0.08;     // Furnish keeps this distance to the middle of walls
constexpr double kMost_m = 60;         // chosen: maximum side of a furnished room
constexpr double kStairsFree_m = 0.6;  // chosen: before the first tread and after the last tread
constexpr double kDoorFree_m = 0.85;   // as before doors of generated houses
constexpr double kOpenFree_m = 0.5;    // chosen: where a room has no wall
constexpr double kBody_m = 0.25;       // chosen: radius; the navmesh's is 0.10
constexpr double kTallest_m = 2.1;
constexpr double kKeptShare = 0.8;  // chosen: share of the free ground that stays connected
constexpr int kAttempts = 10;
constexpr std::size_t kMostCorners = 40;  // chosen: of a room, for its largest rectangle

/// Direction of the longest walls, modulo a quarter turn.
double DirectionOf(const Polygon& outline) {
  double longest = 0, yaw = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d d = outline[(i + 1) % outline.size()] - outline[i];
    if (d.norm() <= longest + 1e-6) continue;
    longest = d.norm();
    yaw = std::atan2(d.y(), d.x());
  }
  const double quarter = 0.5 * M_PI;
  return yaw - quarter * std::round(yaw / quarter);
}

Rect BoundsOf(const Polygon& outline) {
  Rect r{1e9, 1e9, -1e9, -1e9};
  for (const Vector2d& p : outline) {
    r = {std::min(r.x0, p.x()), std::min(r.y0, p.y()), std::max(r.x1, p.x()),
         std::max(r.y1, p.y())};
  }
  return r;
}

bool IsIn(const Polygon& outline, const Rect& r) {
  constexpr int kProbes = 8;
  const Rect in = r.Grown(-0.02);
  for (int i = 0; i <= kProbes; ++i) {
    for (int j = 0; j <= kProbes; ++j) {
      const Vector2d p(in.x0 + in.Width() * i / kProbes, in.y0 + in.Depth() * j / kProbes);
      if (!Contains(outline, p)) return false;
    }
  }
  return true;
}

/// The largest rectangle between corners of the outline.
Rect LargestRect(const Polygon& outline) {
  std::set<double> xs, ys;
  for (const Vector2d& p : outline) {
    if (xs.size() >= kMostCorners) break;
    xs.insert(p.x());
    ys.insert(p.y());
  }
  Rect best;
  for (auto x0 = xs.begin(); x0 != xs.end(); ++x0) {
    for (auto x1 = std::next(x0); x1 != xs.end(); ++x1) {
      for (auto y0 = ys.begin(); y0 != ys.end(); ++y0) {
        for (auto y1 = std::next(y0); y1 != ys.end(); ++y1) {
          const Rect r{*x0, *y0, *x1, *y1};
          if (r.Area() > best.Area() + 1e-6 && IsIn(outline, r)) best = r;
        }
      }
    }
  }
  return best;
}

/// Whether the names in `there` include the kind or an equivalent.
bool IsThere(std::string_view kind, const std::set<std::string>& there) {
  static const std::map<std::string_view, std::vector<const char*>> kSame = {
      {"bed group", {"bed"}},
      {"sofa group", {"sofa"}},
      {"couch", {"sofa"}},
      {"tv group", {"tv_monitor"}},
      {"toilet", {"toilet"}},
      {"washbasin group", {"sink", "bathroom cabinet"}},
      {"bathtub", {"bathtub"}},
      {"shower", {"shower"}},
      {"kitchen group", {"counter", "kitchen lower cabinet", "stove", "refrigerator"}},
      {"kitchen cabinet", {"counter", "kitchen lower cabinet"}},
      {"dining group", {"dining table"}},
      {"desk group", {"desk"}},
      {"wardrobe", {"wardrobe"}}};
  const auto found = kSame.find(kind);
  return found != kSame.end() &&
         std::any_of(found->second.begin(), found->second.end(),
                     [&](const char* name) { return there.count(name) != 0; });
}

class RoomFurnisher {
 public:
  RoomFurnisher(const HomePlan& plan, std::size_t room, const sim::Scene& scene)
      : plan_(plan),
        room_(plan.rooms[room]),
        index_(static_cast<int>(room)),
        R_world_room_(DirectionOf(room_.outline)),
        outline_(Turned(room_.outline)),
        rect_(LargestRect(outline_)),
        floor_m_(plan.FloorOf(room_.level)),
        map_(scene, BoundsOf(outline_).Grown(kMargin_m), floor_m_, R_world_room_.inverse()) {
    for (const auto& instance : scene.instances) {
      const Vector3d p = instance.box.Center();
      if (p.z() < floor_m_ - 0.2 || p.z() > floor_m_ + kTallest_m) continue;
      if (!Contains(room_.outline, p.head<2>())) continue;
      there_.insert(instance.name);
      if (!instance.category.empty()) there_.insert(instance.category);
    }
  }

  /// The pieces, in the world frame; empty if none leaves the room passable.
  std::vector<world::Placement> Furnish(world::RoomType type, std::uint64_t seed,
                                        const world::FurnitureSource& source) const {
    const world::HousePlan empty = ShadowOf(type);
    const auto before = map_.PartsOf(map_.Walkable(kBody_m, {}));
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      world::HousePlan plan = empty;
      Rng rng(MixSeed(seed, static_cast<std::uint64_t>(index_)),
              static_cast<std::uint64_t>(attempt));
      world::FurnishRoom(plan, 0, source, rng,
                         [&](std::string_view kind) { return !IsThere(kind, there_); });
      if (!StaysOpen(plan, before)) continue;
      const Pose T_world_room = world::StandAt(Vector3d::Zero(), R_world_room_.angle());
      for (world::Placement& p : plan.furniture) {
        p.T_world_object = T_world_room * p.T_world_object;
        p.room = index_;
      }
      return std::move(plan.furniture);
    }
    return {};
  }

 private:
  Polygon Turned(const Polygon& outline) const {
    Polygon turned;
    for (const Vector2d& p : outline) turned.emplace_back(R_world_room_.inverse() * p);
    return turned;
  }

  /// The room alone, as a plan for the furnishing of generated houses.
  world::HousePlan ShadowOf(world::RoomType type) const {
    world::HousePlan plan;
    const HomeLevel& level = plan_.levels[static_cast<std::size_t>(room_.level)];
    const double height_m = room_.height_m > 0 ? room_.height_m : level.height_m;
    plan.levels.push_back({floor_m_, floor_m_ + height_m});
    world::Room room;
    room.type = type;
    room.rects = {rect_.Grown(kToWall_m)};
    plan.rooms.push_back(room);
    AddWalls(plan);
    AddDoors(plan);
    AddCells(plan);
    return plan;
  }

  /// Adds walls along sides with fixed structure behind them; other sides stay passable.
  void AddWalls(world::HousePlan& plan) const {
    const Vector2d corners[] = {
        {rect_.x0, rect_.y0}, {rect_.x1, rect_.y0}, {rect_.x1, rect_.y1}, {rect_.x0, rect_.y1}};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d a = corners[i], b = corners[(i + 1) % 4], d = (b - a).normalized();
      const Vector2d out(d.y(), -d.x());
      const int steps = static_cast<int>((b - a).norm() / RoomMap::kCell_m);
      int from = 0;
      for (int k = 0; k <= steps; ++k) {
        const bool is_end = k == steps;
        const bool here = !is_end && HasWallBehind(a + d * ((k + 0.5) * RoomMap::kCell_m), out);
        const bool before = k > 0 && HasWallBehind(a + d * ((k - 0.5) * RoomMap::kCell_m), out);
        if (k == 0 || (here == before && !is_end)) continue;
        AddRun(plan, a + d * (from * RoomMap::kCell_m), a + d * (k * RoomMap::kCell_m),
               before ? Vector2d::Zero() : out);
        from = k;
      }
    }
  }

  /// `out` points to the open side; zero for a wall.
  static void AddRun(world::HousePlan& plan, const Vector2d& a, const Vector2d& b,
                     const Vector2d& out) {
    if ((b - a).norm() < 0.2) return;
    if (out.isZero()) {
      world::Wall wall;
      wall.a = a;
      wall.b = b;
      plan.walls.push_back(wall);
      return;
    }
    const Vector2d in = -kOpenFree_m * out;
    Box3 box;
    const double z = plan.levels[0].floor_m;
    for (const Vector2d& p : {a, b, Vector2d(a + in), Vector2d(b + in)}) {
      box.Add({p.x(), p.y(), z - 1});
      box.Add({p.x(), p.y(), z + kTallest_m});
    }
    plan.taken.push_back(box);
  }

  bool HasWallBehind(const Vector2d& p, const Vector2d& out) const {
    for (double s = -0.05; s < 0.3; s += 0.5 * RoomMap::kCell_m) {
      if (map_.At(Vector2d(p + s * out)).has_wall) return true;
    }
    return false;
  }

  void AddDoors(world::HousePlan& plan) const {
    for (const HomePiece& piece : plan_.pieces) {
      const bool is_window =
          piece.raw_name == "window" || (piece.kind == PieceKind::kOpening && piece.bottom_m > 0.4);
      if (piece.kind != PieceKind::kOpening && !is_window) continue;
      const double low = plan_.FloorOf(piece.level) + piece.bottom_m;
      if (low > floor_m_ + kTallest_m || low + piece.height_m < floor_m_ + 0.3) continue;
      const double x = 0.5 * piece.width_m + (is_window ? 0.0 : 0.1);
      const double y = 0.5 * piece.depth_m + (is_window ? 0.25 : kDoorFree_m);
      Box3 box;
      for (const double sx : {-x, x}) {
        for (const double sy : {-y, y}) {
          const Vector2d p = R_world_room_.inverse() * OnPlan(piece, sx, sy);
          box.Add({p.x(), p.y(), is_window ? low : floor_m_ - 1});
          box.Add({p.x(), p.y(), low + piece.height_m});
        }
      }
      plan.taken.push_back(box);
    }
  }

  /// Adds furniture, holes in the floor and the ends of stairs.
  void AddCells(world::HousePlan& plan) const {
    const Rect in = rect_.Grown(-0.1);
    const int reach = static_cast<int>(kStairsFree_m / RoomMap::kCell_m);
    for (int y = 0; y < map_.ny(); ++y) {
      for (int x = 0; x < map_.nx(); ++x) {
        const RoomMap::Cell& cell = map_.At(x, y);
        const Vector2d p = map_.MiddleOf(x, y);
        const double half = 0.5 * RoomMap::kCell_m;
        if (cell.has_stairs && rect_.Grown(kStairsFree_m).Contains(p)) {
          if (IsEdgeOfStairs(x, y)) Take(plan, p, reach * RoomMap::kCell_m, -1, kTallest_m);
          continue;
        }
        if (!in.Contains(p)) continue;
        if (!cell.has_ground) Take(plan, p, half, -1, kTallest_m);
        if (cell.low_m <= cell.high_m) Take(plan, p, half, cell.low_m, cell.high_m + 0.02);
      }
    }
  }

  bool IsEdgeOfStairs(int x, int y) const {
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      const int i = std::clamp(x + dx, 0, map_.nx() - 1), j = std::clamp(y + dy, 0, map_.ny() - 1);
      if (!map_.At(i, j).has_stairs) return true;
    }
    return false;
  }

  void Take(world::HousePlan& plan, const Vector2d& p, double half, double low, double high) const {
    Box3 box;
    box.Add({p.x() - half, p.y() - half, floor_m_ + low});
    box.Add({p.x() + half, p.y() + half, floor_m_ + high});
    plan.taken.push_back(box);
  }

  /// Whether every walkable part stays connected, apart from the cells under the pieces.
  bool StaysOpen(const world::HousePlan& plan, const std::vector<int>& before) const {
    std::vector<Rect> bodies;
    for (const world::Placement& p : plan.furniture) {
      const Box3 b = world::BoxAt(p.model, p.T_world_object);
      if (b.max.z() < floor_m_ + 0.05 || b.min.z() > floor_m_ + 1.6) continue;
      bodies.push_back({b.min.x(), b.min.y(), b.max.x(), b.max.y()});
    }
    const auto after = map_.PartsOf(map_.Walkable(kBody_m, bodies));
    std::map<int, std::map<int, int>> split;  // cells of each part before, by part after
    std::map<int, std::set<int>> outer;       // likewise outside the room
    for (int y = 0; y < map_.ny(); ++y) {
      for (int x = 0; x < map_.nx(); ++x) {
        const std::size_t i = map_.Index(x, y);
        if (before[i] == 0 || after[i] == 0) continue;
        ++split[before[i]][after[i]];
        if (!Contains(outline_, map_.MiddleOf(x, y))) outer[before[i]].insert(after[i]);
      }
    }
    for (const auto& [part, pieces] : split) {
      if (outer[part].size() > 1) return false;
      int all = 0, most = 0;
      for (const auto& [id, cells] : pieces) {
        all += cells;
        most = std::max(most, cells);
      }
      if (most < kKeptShare * all) return false;
    }
    return true;
  }

  const HomePlan& plan_;
  const HomeRoom& room_;
  int index_;
  Eigen::Rotation2Dd R_world_room_;
  Polygon outline_;
  Rect rect_;
  double floor_m_;
  RoomMap map_;
  std::set<std::string> there_;
};

}  // namespace

void FurnishHome(HomePlan& plan, const sim::Scene& scene, std::uint64_t seed,
                 const world::FurnitureSource& source, std::vector<std::string>& notes) {
  std::map<std::string, int> unknown, full;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const HomeRoom& room = plan.rooms[i];
    const auto type = RoomTypeNamed(room.name);
    const Rect bounds = BoundsOf(room.outline);
    if (!type) ++unknown[room.name];
    if (!type || *type == world::RoomType::kStairwell) continue;
    if (std::max(bounds.Width(), bounds.Depth()) > kMost_m) continue;
    auto added = RoomFurnisher(plan, i, scene).Furnish(*type, seed, source);
    if (added.empty()) ++full[room.name];
    std::move(added.begin(), added.end(), std::back_inserter(plan.furnishing));
  }
  for (const auto& [name, count] : unknown) {
    notes.push_back(fmt::format("{} rooms '{}' are of no known type and stay empty", count, name));
  }
  for (const auto& [name, count] : full) {
    notes.push_back(fmt::format("{} rooms '{}' have no place for furniture", count, name));
  }
}

}  // namespace crossnav::homes
