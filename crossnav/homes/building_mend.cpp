// SPDX-License-Identifier: MIT
// Missing floors of a building: architects omit slabs, or draw one slab per room, which leaves gaps
// under the doors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "crossnav/homes/building_home.h"
#include "crossnav/homes/piece_model.h"

namespace crossnav::homes {
namespace {

constexpr double kBelowSlab_m = 0.35,
                 kAboveSlab_m = 0.12;  // chosen: of a slab's top to a space's ground
constexpr int kSamples = 16;           // chosen: along each side of a room
constexpr double kStoreyShare = 0.3;   // chosen: below this share a storey has no slab
constexpr double kRoomShare = 0.05;    // chosen: below this share a room has no slab
constexpr double kStorey_m = 0.3;

/// Near-level, walkable triangles of a scene.
class Ground {
 public:
  explicit Ground(const sim::Scene& scene) {
    for (const auto& t : scene.mesh.triangles) {
      const std::array<Vector3d, 3> p = {scene.mesh.vertices[t[0]].cast<double>(),
                                         scene.mesh.vertices[t[1]].cast<double>(),
                                         scene.mesh.vertices[t[2]].cast<double>()};
      const Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
      if (std::abs(n.z()) > 0.7 * n.norm() && n.norm() > 1e-9) triangles_.push_back(p);
    }
  }

  /// The triangles that reach into a height.
  Ground Near(double floor_m) const {
    Ground near;
    for (const auto& p : triangles_) {
      const auto [low, high] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
      if (high >= floor_m - kBelowSlab_m && low <= floor_m + kAboveSlab_m)
        near.triangles_.push_back(p);
    }
    return near;
  }

  bool Holds(const Vector2d& q) const {
    return std::any_of(triangles_.begin(), triangles_.end(), [&](const auto& p) {
      double sign = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector2d a = p[i].template head<2>(), b = p[(i + 1) % 3].template head<2>();
        const double side = (b - a).x() * (q - a).y() - (b - a).y() * (q - a).x();
        if (side * sign < 0) return false;
        if (side != 0) sign = side;
      }
      return true;
    });
  }

 private:
  Ground() = default;
  std::vector<std::array<Vector3d, 3>> triangles_;
};

/// Share of a room with ground.
double ShareOf(const HomeRoom& room, const Ground& ground) {
  Vector2d low = room.outline.front(), high = low;
  for (const Vector2d& p : room.outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  int inside = 0, covered = 0;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const Vector2d at((i % kSamples + 0.5) / kSamples, (i / kSamples + 0.5) / kSamples);
    const Vector2d q = low + at.cwiseProduct(high - low);
    if (!Contains(room.outline, q)) continue;
    ++inside;
    covered += ground.Holds(q) ? 1 : 0;
  }
  return inside == 0 ? 1 : static_cast<double>(covered) / inside;
}

}  // namespace

void MendFloors(HomePlan& plan, const sim::Scene& scene) {
  const Ground all(scene);
  std::vector<double> share(plan.rooms.size(), 1);
  std::map<int, std::pair<double, double>> storey;  // area and ground, by height
  const auto key = [&](const HomeRoom& room) {
    return static_cast<int>(std::lround(plan.FloorOf(room.level) / kStorey_m));
  };
  for (std::size_t i = 0; i < share.size(); ++i) {
    const HomeRoom& room = plan.rooms[i];
    share[i] = ShareOf(room, all.Near(plan.FloorOf(room.level)));
    auto& [area, ground] = storey[key(room)];
    area += SignedArea(room.outline);
    ground += share[i] * SignedArea(room.outline);
  }
  std::map<std::string, int> drawn;
  for (std::size_t i = 0; i < share.size(); ++i) {
    HomeRoom& room = plan.rooms[i];
    const auto& [area, ground] = storey[key(room)];
    const bool has_slab = ground >= kStoreyShare * area;
    if (has_slab && share[i] >= kRoomShare) continue;
    room.draws_floor = true;
    const std::string name = plan.levels[static_cast<std::size_t>(room.level)].name;
    if (has_slab) {
      plan.notes.push_back("'" + room.name + "' has no slab; its outline is its floor");
    } else {
      ++drawn[name];
    }
  }
  for (const auto& [name, count] : drawn) {
    plan.notes.push_back(
        fmt::format("'{}' has no slab; the outlines of its {} rooms are its floor", name, count));
  }
}

void MendThresholds(BuildingHome& home, const sim::Scene& scene) {
  const Ground all(scene);
  const std::size_t count = home.plan.pieces.size();
  int mended = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const HomePiece& door = home.plan.pieces[i];
    if (!IsInnerDoor(home.plan, door)) continue;
    const Ground ground = all.Near(home.plan.FloorOf(door.level));
    const double reach = 0.5 * door.depth_m;
    bool is_whole = true;
    for (const double share : {-0.9, -0.45, 0.0, 0.45, 0.9}) {
      is_whole = is_whole && ground.Holds(OnPlan(door, 0.1 * door.width_m, share * reach));
    }
    if (is_whole) continue;
    HomePiece threshold = door;
    threshold.kind = PieceKind::kFurniture;
    threshold.name = threshold.raw_name = "floor";
    threshold.depth_m += 0.06;  // chosen: under the edges of both floors
    threshold.height_m = 0.05;
    threshold.bottom_m = -0.05;
    threshold.sashes.clear();
    home.models[home.plan.pieces.size()] = BoxFor(threshold);
    home.plan.pieces.push_back(std::move(threshold));
    ++mended;
  }
  if (mended == 0) return;
  home.plan.notes.push_back(fmt::format("{} inner doors get a threshold where no slab is", mended));
}

}  // namespace crossnav::homes
