// SPDX-License-Identifier: MIT
// Occupancy of a room and its surroundings, from above, in cells of 5 cm: space for furniture and
// walkways. The room's own frame: rotated so that its walls are along x and y; metres.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/homes/polygon.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/mesh/rect.h"

namespace crossnav::homes {

class RoomMap {
 public:
  static constexpr double kCell_m = 0.05;
  struct Cell {
    bool has_ground = false;
    bool has_stairs = false;             ///< down to a storey below, or up
    bool has_wall = false;               ///< fixed structure at the height of a picture
    float low_m = 1e9F, high_m = -1e9F;  ///< of objects above the floor, relative to the floor
  };

  /// `T_room_world` turns about the world's z axis.
  RoomMap(const sim::Scene& scene, const world::Rect& area, double floor_m,
          const Eigen::Rotation2Dd& R_room_world);

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  const Cell& At(int x, int y) const { return cells_[Index(x, y)]; }
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(x);
  }
  Vector2d MiddleOf(int x, int y) const {
    return {area_.x0 + (x + 0.5) * kCell_m, area_.y0 + (y + 0.5) * kCell_m};
  }
  /// Cell of a point; outside the map the nearest cell.
  const Cell& At(const Vector2d& p) const;

  /// Cells with ground and room for a person of this radius, with `more` as additional obstacles.
  std::vector<bool> Walkable(double radius_m, const std::vector<world::Rect>& more) const;
  /// Walkable cells by connected part, 1, 2, ...; 0 = not walkable.
  std::vector<int> PartsOf(const std::vector<bool>& walkable) const;

 private:
  void Add(const Vector3d& p, bool is_level, bool is_stairs, bool is_fixed);

  world::Rect area_;
  int nx_ = 0, ny_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace crossnav::homes
