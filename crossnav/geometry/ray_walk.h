// SPDX-License-Identifier: MIT
// Exact traversal of the voxels that a segment passes through (Amanatides and Woo 1987). The time
// of crossing a face is computed from the face itself, never accumulated, so that crossings of one
// axis are ordered whatever the rounding; equal times are taken in the order x, y, z. Units:
// voxels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

/// The voxel of a point given in voxels.
inline VoxelKey KeyOfVoxelPoint(const Vector3d& p_vox) {
  return {static_cast<std::int32_t>(std::floor(p_vox.x())),
          static_cast<std::int32_t>(std::floor(p_vox.y())),
          static_cast<std::int32_t>(std::floor(p_vox.z()))};
}

/// Calls visit(key) for every voxel on the segment before the voxel of `end_vox`, in order from
/// `start_vox`. Stops early if visit returns false. Cost O(voxels).
template <class F>
void WalkRay(const Vector3d& start_vox, const Vector3d& end_vox, F&& visit) {
  const VoxelKey start = KeyOfVoxelPoint(start_vox), end = KeyOfVoxelPoint(end_vox);
  std::array<std::int32_t, 3> cell = {start.x, start.y, start.z};
  const std::array<std::int32_t, 3> last = {end.x, end.y, end.z};
  std::array<int, 3> step{}, left{};
  std::array<double, 3> inverse{}, time{};
  const auto time_of = [&](int a) {
    const double face = step[a] > 0 ? cell[a] + 1 : cell[a];
    return left[a] > 0 ? (face - start_vox[a]) * inverse[a]
                       : std::numeric_limits<double>::infinity();
  };
  int total = 0;
  for (int a = 0; a < 3; ++a) {
    step[a] = last[a] > cell[a] ? 1 : -1;
    left[a] = std::abs(last[a] - cell[a]);
    inverse[a] = 1 / (end_vox[a] - start_vox[a]);
    time[a] = time_of(a);
    total += left[a];
  }
  for (; total > 0; --total) {
    if (!visit(VoxelKey{cell[0], cell[1], cell[2]})) return;
    int a = time[1] < time[0] ? 1 : 0;
    if (time[2] < time[a]) a = 2;
    cell[a] += step[a];
    --left[a];
    time[a] = time_of(a);
  }
}

/// True if WalkRay visits `voxel`, without walking: of each axis, the crossing into the voxel must
/// come before every other axis's crossing out of it. The same floating-point times and tie rule,
/// so the answer is the same bit for bit. Cost O(1).
inline bool RayPasses(const Vector3d& start_vox, const Vector3d& end_vox, const VoxelKey& voxel) {
  const VoxelKey start = KeyOfVoxelPoint(start_vox), end = KeyOfVoxelPoint(end_vox);
  if (voxel == end) return false;
  const std::array<std::int32_t, 3> first = {start.x, start.y, start.z};
  const std::array<std::int32_t, 3> last = {end.x, end.y, end.z};
  const std::array<std::int32_t, 3> cell = {voxel.x, voxel.y, voxel.z};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> enter{}, leave{};
  for (int a = 0; a < 3; ++a) {
    if (cell[a] < std::min(first[a], last[a]) || cell[a] > std::max(first[a], last[a]))
      return false;
    const int is_up = last[a] > first[a] ? 1 : 0;
    const double inverse = 1 / (end_vox[a] - start_vox[a]);
    const double face_in = cell[a] + 1 - is_up, face_out = cell[a] + is_up;
    enter[a] = cell[a] == first[a] ? -kInfinity : (face_in - start_vox[a]) * inverse;
    leave[a] = cell[a] == last[a] ? kInfinity : (face_out - start_vox[a]) * inverse;
  }
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      if (a == b) continue;
      const bool is_before = enter[a] < leave[b] || (enter[a] == leave[b] && a < b);
      if (!is_before) return false;
    }
  return true;
}

}  // namespace crossnav::geometry
