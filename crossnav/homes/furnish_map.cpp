// SPDX-License-Identifier: MIT
#include "crossnav/homes/furnish_map.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace crossnav::homes {
namespace {

constexpr double kSample_m = 0.035;  // chosen: no cell is missed
constexpr double kGroundLow_m = -0.35, kGroundHigh_m = 0.12;
constexpr double kStandsFrom_m = 0.13, kStandsTo_m = 2.3;
constexpr double kWalkTo_m = 1.6;
constexpr double kWallFrom_m = 0.9, kWallTo_m = 1.3;
constexpr double kStairsFrom_m = -1.5, kStairsTo_m = 2.3;

std::vector<Vector3d> Clipped(std::vector<Vector3d> polygon, const Vector3d& low,
                              const Vector3d& high) {
  for (Eigen::Index axis = 0; axis < 3 && !polygon.empty(); ++axis) {
    polygon = SideOf(polygon, axis, low[axis], 1);
    polygon = SideOf(polygon, axis, high[axis], -1);
  }
  return polygon;
}

bool IsFixed(std::string_view name) {
  for (const std::string_view fixed : {"wall", "column", "window", "roof"}) {
    if (name == fixed) return true;
  }
  return false;
}

}  // namespace

RoomMap::RoomMap(const sim::Scene& scene, const world::Rect& area, double floor_m,
                 const Eigen::Rotation2Dd& R_room_world)
    : area_(area),
      nx_(std::max(1, static_cast<int>(std::ceil(area.Width() / kCell_m)))),
      ny_(std::max(1, static_cast<int>(std::ceil(area.Depth() / kCell_m)))) {
  cells_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
  const Vector3d low(area.x0, area.y0, kStairsFrom_m), high(area.x1, area.y1, kStairsTo_m);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    std::vector<Vector3d> corners;
    for (const auto v : scene.mesh.triangles[t]) {
      const Vector3d p = scene.mesh.vertices[v].cast<double>();
      const Vector2d q = R_room_world * p.head<2>();
      corners.emplace_back(q.x(), q.y(), p.z() - floor_m);
    }
    corners = Clipped(std::move(corners), low, high);
    if (corners.size() < 3) continue;
    const auto* instance = scene.FindInstance(scene.mesh.triangle_instance[t]);
    const std::string_view name = instance == nullptr ? "" : std::string_view(instance->name);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vector3d &a = corners[0], u = corners[i] - a, v = corners[i + 1] - a;
      const Vector3d normal = u.cross(v);
      const bool is_level = std::abs(normal.z()) > 0.5 * normal.norm();
      const int steps =
          1 + static_cast<int>(std::max({u.norm(), v.norm(), (u - v).norm()}) / kSample_m);
      for (int j = 0; j <= steps; ++j) {
        for (int k = 0; k <= steps - j; ++k) {
          Add(a + u * (static_cast<double>(j) / steps) + v * (static_cast<double>(k) / steps),
              is_level, name == "stairs", IsFixed(name));
        }
      }
    }
  }
}

void RoomMap::Add(const Vector3d& p, bool is_level, bool is_stairs, bool is_fixed) {
  const int x = std::clamp(static_cast<int>((p.x() - area_.x0) / kCell_m), 0, nx_ - 1);
  const int y = std::clamp(static_cast<int>((p.y() - area_.y0) / kCell_m), 0, ny_ - 1);
  Cell& cell = cells_[Index(x, y)];
  const double z = p.z();
  if (is_stairs) {
    cell.has_stairs = true;
    return;
  }
  if (is_level && z > kGroundLow_m && z < kGroundHigh_m) cell.has_ground = true;
  if (z < kStandsFrom_m) return;
  if (is_fixed && z > kWallFrom_m && z < kWallTo_m) cell.has_wall = true;
  cell.low_m = std::min(cell.low_m, static_cast<float>(z));
  cell.high_m = std::max(cell.high_m, static_cast<float>(z));
}

const RoomMap::Cell& RoomMap::At(const Vector2d& p) const {
  return At(std::clamp(static_cast<int>((p.x() - area_.x0) / kCell_m), 0, nx_ - 1),
            std::clamp(static_cast<int>((p.y() - area_.y0) / kCell_m), 0, ny_ - 1));
}

std::vector<bool> RoomMap::Walkable(double radius_m, const std::vector<world::Rect>& more) const {
  const int reach = static_cast<int>(radius_m / kCell_m);
  std::vector<bool> taken(cells_.size(), false);
  for (int y = 0; y < ny_; ++y) {
    for (int x = 0; x < nx_; ++x) {
      const Cell& cell = At(x, y);
      const Vector2d p = MiddleOf(x, y);
      taken[Index(x, y)] = cell.low_m < kWalkTo_m ||
                           std::any_of(more.begin(), more.end(),
                                       [&](const world::Rect& r) { return r.Contains(p); });
    }
  }
  std::vector<bool> walkable(cells_.size(), false);
  for (int y = 0; y < ny_; ++y) {
    for (int x = 0; x < nx_; ++x) {
      bool is_free = At(x, y).has_ground || At(x, y).has_stairs;
      for (int j = -reach; j <= reach && is_free; ++j) {
        for (int i = -reach; i <= reach && is_free; ++i) {
          if (i * i + j * j > reach * reach) continue;
          const int u = x + i, v = y + j;
          if (u >= 0 && v >= 0 && u < nx_ && v < ny_ && taken[Index(u, v)]) is_free = false;
        }
      }
      walkable[Index(x, y)] = is_free;
    }
  }
  return walkable;
}

std::vector<int> RoomMap::PartsOf(const std::vector<bool>& walkable) const {
  std::vector<int> part(cells_.size(), 0);
  int count = 0;
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < ny_; ++y) {
    for (int x = 0; x < nx_; ++x) {
      if (!walkable[Index(x, y)] || part[Index(x, y)] != 0) continue;
      ++count;
      open.assign(1, {x, y});
      part[Index(x, y)] = count;
      while (!open.empty()) {
        const auto [u, v] = open.back();
        open.pop_back();
        for (const auto& [du, dv] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          const int i = u + du, j = v + dv;
          if (i < 0 || j < 0 || i >= nx_ || j >= ny_) continue;
          if (!walkable[Index(i, j)] || part[Index(i, j)] != 0) continue;
          part[Index(i, j)] = count;
          open.emplace_back(i, j);
        }
      }
    }
  }
  return part;
}

}  // namespace crossnav::homes
