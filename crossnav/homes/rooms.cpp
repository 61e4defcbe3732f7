// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/homes/shell.h"

namespace crossnav::homes {
namespace {

constexpr double kSameHeight_m = 0.05;  // chosen: floors of one storey
constexpr Rgb8 kFloorColour{190, 184, 176}, kCeilingColour{240, 240, 238};

/// Cut-outs of staircases in a slab between z0 and z1.
std::vector<Polygon> Cuts(const HomePlan& plan, double z0, double z1) {
  std::vector<Polygon> cuts;
  for (const HomePiece& piece : plan.pieces) {
    if (piece.kind != PieceKind::kStairs) continue;
    const double foot = plan.FloorOf(piece.level) + piece.bottom_m;
    if (foot > z0 - 0.1 || foot + piece.height_m < z1 - 0.02) continue;
    for (const Polygon& part : piece.floor_cut) {
      Polygon cut;
      for (const Vector2d& p : part) {
        const double x = piece.is_mirrored ? 1 - p.x() : p.x();
        cut.push_back(OnPlan(piece, (x - 0.5) * piece.width_m, (0.5 - p.y()) * piece.depth_m));
      }
      if (cut = Cleaned(cut); !cut.empty()) cuts.push_back(std::move(cut));
    }
  }
  return cuts;
}

/// Area covered by later rooms of the same height.
std::vector<Polygon> Covered(const HomePlan& plan, std::size_t room, bool HomeRoom::*has) {
  std::vector<Polygon> covered;
  for (std::size_t i = room + 1; i < plan.rooms.size(); ++i) {
    const HomeRoom& other = plan.rooms[i];
    if (!(other.*has)) continue;
    const double apart = plan.FloorOf(other.level) - plan.FloorOf(plan.rooms[room].level);
    if (std::abs(apart) > kSameHeight_m) continue;
    for (Polygon& part : Triangulate(other.outline)) covered.push_back(std::move(part));
  }
  return covered;
}

}  // namespace

double SlabAbove(const HomePlan& plan, int level) {
  const HomeLevel& here = plan.levels[static_cast<std::size_t>(level)];
  for (const HomeLevel& above : plan.levels) {
    const double gap = above.floor_m - (here.floor_m + here.height_m);
    if (gap > 0 && gap < 1 && std::abs(gap - above.slab_m) < 0.01) return above.slab_m;
  }
  return 0.05;  // chosen: closes the top of a wall
}

int RoomAt(const HomePlan& plan, int level, const Vector2d& p) {
  for (std::size_t i = plan.rooms.size(); i-- > 0;) {
    const HomeRoom& room = plan.rooms[i];
    if (std::abs(plan.FloorOf(room.level) - plan.FloorOf(level)) > kSameHeight_m) continue;
    if (Contains(room.outline, p)) return static_cast<int>(i);
  }
  return -1;
}

void BuildRooms(const HomePlan& plan, const UseFinish& use, world::SceneBuilder& scene) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const HomeRoom& room = plan.rooms[i];
    const HomeLevel& level = plan.levels[static_cast<std::size_t>(room.level)];
    const std::vector<Polygon> parts = Triangulate(room.outline);
    const int region = static_cast<int>(i);
    if (room.has_floor && room.draws_floor) {
      const double low = level.floor_m - kFloorShare * level.slab_m;
      auto pieces = Subtract(parts, Covered(plan, i, &HomeRoom::has_floor));
      pieces = Subtract(std::move(pieces), Cuts(plan, low, level.floor_m));
      scene.BeginInstance("floor", region);
      use(room.floor, kFloorColour);
      for (const Polygon& piece : pieces) scene.mesh.AddPrism(piece, low, level.floor_m);
    }
    if (room.has_ceiling && room.draws_ceiling) {
      const double low = level.floor_m + level.height_m;
      const double high = low + (1 - kFloorShare) * SlabAbove(plan, room.level);
      auto pieces = Subtract(parts, Covered(plan, i, &HomeRoom::has_ceiling));
      pieces = Subtract(std::move(pieces), Cuts(plan, low, high));
      scene.BeginInstance("ceiling", region);
      use(room.ceiling, kCeilingColour);
      for (const Polygon& piece : pieces) scene.mesh.AddPrism(piece, low, high);
    }
  }
}

}  // namespace crossnav::homes
