// SPDX-License-Identifier: MIT
// Parts of the walkable surface that are connected without a floor change: points as dense as the
// navmesh's cells, flood-filled, cut where the floor changes. Exhaustive, and independent of
// Detour's searches. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav::evaluation {

class FloorParts {
 public:
  explicit FloorParts(const sim::NavMesh& navmesh);

  /// Part of `p_world`; -1 = none.
  int PartAt(const Vector3d& p_world) const;

  /// True if `holds(point)` is true for some point of the part.
  template <class Holds>
  bool AnyPoint(int part, Holds&& holds) const {
    for (const Point& point : points_) {
      if (point.part == part && holds(Place(point))) return true;
    }
    return false;
  }

 private:
  struct Point {
    int x = 0, y = 0;  // in cells
    float z = 0;
    int part = 0;
  };
  Vector3d Place(const Point& point) const {
    return {point.x * grid_m_, point.y * grid_m_, point.z};
  }

  double grid_m_;
  std::vector<Point> points_;  // by x, y, z
};

}  // namespace crossnav::evaluation
