// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_runs.h"

#include <cmath>
#include <cstdlib>

#include "crossnav/core/cells.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::planner {
namespace {

constexpr double kRun_m = 0.8;           // chosen: six treads of the shortest flight
constexpr double kDeepTread_m = 0.35;    // chosen: deeper is a seat, or a landing
constexpr double kShortTread_m = 0.125;  // chosen: a body's radius and a quarter; less is a shelf
constexpr int kRises = 3;                // chosen: two are a seat with a rounded front, or a shelf

/// Rises along a line of columns; column 0 is the destination of the step.
struct Run {
  int rises = 0;
  int first = 0, last = 0;  ///< columns of the lowest and the highest riser
};

/// Columns of a line in direction (dx, dy) that lie within `length_m`.
int ColumnsWithin(const GroundMap& ground, double length_m, int dx, int dy) {
  return CellsFloor(length_m, ground.voxel_m() * std::hypot(dx, dy));
}

void FollowUp(const GroundMap& ground, VoxelKey at, int dx, int dy, Run& run) {
  const int deep = ColumnsWithin(ground, kDeepTread_m, dx, dy);
  const int reach = ColumnsWithin(ground, kRun_m, dx, dy);
  for (int k = 1; k <= reach && k - run.last <= deep; ++k) {
    const auto rise = ground.RiseAt({at.x + k * dx, at.y + k * dy, at.z});
    if (!rise || *rise < 0) return;
    if (*rise == 0) continue;
    at.z += *rise;
    run.last = k;
    ++run.rises;
  }
}

void FollowDown(const GroundMap& ground, VoxelKey at, int dx, int dy, Run& run) {
  const int deep = ColumnsWithin(ground, kDeepTread_m, dx, dy);
  const int reach = ColumnsWithin(ground, kRun_m, dx, dy);
  for (int k = 1; k <= reach && k + run.first <= deep; ++k) {
    const auto z = ground.StandingNear(at.x - k * dx, at.y - k * dy, at.z, ground.climb());
    if (!z || *z == at.z) continue;
    if (*z > at.z) return;
    at.z = *z;
    run.first = -k;
    ++run.rises;
  }
}

}  // namespace

int RunReach_vox(double voxel_m) {
  return CellsCeil(kRun_m, voxel_m) + 1;
}

bool IsHighBehind(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to) {
  const auto is_high = [&](int dx, int dy) {
    for (int k = 1; k <= ground.radius(); ++k) {
      const auto z = ground.StandingNear(to.x + k * dx, to.y + k * dy, to.z, ground.climb());
      if (z && *z - from.z > ground.climb()) return true;
    }
    return false;
  };
  const int dx = to.x - from.x, dy = to.y - from.y;
  return is_high(dx, dy) || (dx != 0 && dy != 0 && (is_high(dx, 0) || is_high(0, dy)));
}

bool IsStepOfFlight(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to) {
  const int dx = to.x - from.x, dy = to.y - from.y;
  Run run{1, 0, 0};
  FollowUp(ground, to, dx, dy, run);
  FollowDown(ground, from, dx, dy, run);
  if (run.rises < kRises) return false;
  const double length_m = (run.last - run.first) * ground.voxel_m() * std::hypot(dx, dy);
  return length_m >= (run.rises - 1) * kShortTread_m - 1e-9;
}

}  // namespace crossnav::planner
