// SPDX-License-Identifier: MIT
#include "crossnav/policy/search_field.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;

constexpr double kBelow_m = 0.15;    // chosen: ground is known to a voxel
constexpr double kHeadRoom_m = 0.5;  // chosen: less is the space under a bed or a table
constexpr int kLeastColumns = 4;     // chosen: a quarter of a patch; less is an edge ...
constexpr int kLeastEdge = 2;        // chosen: ... and of tops as high as the camera all that shows
constexpr double kLowTop_m = 0.3;    // chosen: lower ones show from above
constexpr double kLevel_m = 0.15;    // chosen: one surface, to a voxel and a half
constexpr double kSlack_m = 0.12;    // chosen: half a thing on the patch; less than a wall
constexpr double kLeastDepth_m = 0.1;  // chosen: least depth in a picture

VoxelKey CellOf(const VoxelKey& key) {
  return {key.x >> 2, key.y >> 2, key.z >> 2};
}

/// A surface that an object can stand on: seen air above it, and room.
bool IsSupport(VoxelMap::Cursor& cursor, const VoxelKey& key, int head_room_vox) {
  const VoxelState above = cursor.At({key.x, key.y, key.z + 1}).state;
  if (above == VoxelState::kUnknown) return false;
  for (int dz = 1; dz <= head_room_vox; ++dz)
    if (geometry::IsSurface(cursor.At({key.x, key.y, key.z + dz}).state)) return false;
  return true;
}

/// Columns of a cell whose surface is about level.
struct CellSum {
  Vector3d p_world = Vector3d::Zero();  ///< sum of the voxels' centres
  int count = 0;

  void Add(const Vector3d& p) {
    p_world += p;
    ++count;
  }
  double MeanHeight() const { return p_world.z() / count; }
};
using CellSums = std::map<VoxelKey, CellSum>;

/// Calls visit(value) for the cells around `cell` and itself: a top may lie at the border of two.
template <class Value, class F>
void ForEachAround(const std::map<VoxelKey, Value>& cells, const VoxelKey& cell, F&& visit) {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dz = -1; dz <= 1; ++dz)
        if (const auto it = cells.find({cell.x + dx, cell.y + dy, cell.z + dz}); it != cells.end())
          visit(it->second);
}

/// Whether the surface of `cell` goes on in `sums`, in the same cell or one beside it.
bool GoesOn(const CellSums& sums, const VoxelKey& cell, double height_m) {
  bool goes_on = false;
  ForEachAround(sums, cell, [&](const CellSum& sum) {
    goes_on |= sum.count >= kLeastEdge && std::abs(sum.MeanHeight() - height_m) <= kLevel_m;
  });
  return goes_on;
}

/// Notes a look at `p_camera`, a point in the camera's frame.
void LookAt(const Vector3d& p_camera, const Observation& obs, double range_m, Looked* looked) {
  if (p_camera.z() < kLeastDepth_m || p_camera.z() > range_m) return;
  const auto distance_m = static_cast<float>(p_camera.norm());
  // The look for the goal is never nearer than the look of the run.
  if (distance_m > range_m || distance_m >= looked->for_goal_m) return;
  const int u =
      static_cast<int>(std::lround(obs.camera.fx * p_camera.x() / p_camera.z() + obs.camera.cx));
  const int v =
      static_cast<int>(std::lround(obs.camera.fy * p_camera.y() / p_camera.z() + obs.camera.cy));
  if (!obs.depth_m.Contains(u, v)) return;
  const float depth_m = obs.depth_m.At(u, v);
  if (!std::isfinite(depth_m) || depth_m < p_camera.z() - kSlack_m) return;
  looked->in_run_m = std::min(looked->in_run_m, distance_m);
  looked->for_goal_m = distance_m;
}

}  // namespace

void SearchField::Update(const VoxelMap& map, double level_m, double eye_m, const VoxelKey& lo,
                         const VoxelKey& hi) {
  const double voxel_m = map.config().voxel_m;
  // Whole cells only: half a patch at the edge of the box would be another patch.
  const VoxelKey from{lo.x & ~3, lo.y & ~3, geometry::KeyOf({0, 0, level_m - kBelow_m}, voxel_m).z};
  const VoxelKey to{hi.x | 3, hi.y | 3,
                    geometry::KeyOf({0, 0, level_m + SearchPatch::kHighestTop_m}, voxel_m).z};
  const int head_room_vox = CellsFloor(kHeadRoom_m, voxel_m);
  const int eye_z = geometry::KeyOf({0, 0, level_m + eye_m}, voxel_m).z;
  CellSums sums, unseen;
  VoxelMap::Cursor cursor(map);
  map.ForEachInBox(from, to, [&](const VoxelKey& key, const geometry::Voxel& voxel) {
    // Stairs are surfaces of other states: nothing stands on a tread.
    if (voxel.state == VoxelState::kOccupied && IsSupport(cursor, key, head_room_vox))
      sums[CellOf(key)].Add(CenterOf(key, voxel_m));
    const VoxelKey below{key.x, key.y, key.z - 1};
    if (below.z < eye_z || geometry::IsSurface(voxel.state) ||
        voxel.state == VoxelState::kUnknown || cursor.At(below).state != VoxelState::kUnknown ||
        !IsSupport(cursor, below, head_room_vox))
      return;
    unseen[CellOf(below)].Add(CenterOf(below, voxel_m));
  });
  std::erase_if(unseen, [&](const auto& entry) {
    return !GoesOn(sums, entry.first, entry.second.MeanHeight());
  });
  for (const auto& [cell, sum] : unseen) {
    sums[cell].p_world += sum.p_world;
    sums[cell].count += sum.count;
  }
  const auto is_patch = [&](const CellSum& sum) {
    const bool is_low = sum.MeanHeight() < level_m + kLowTop_m;
    return sum.count >= (is_low ? kLeastColumns : kLeastEdge);
  };
  const VoxelKey first = CellOf(from), last = CellOf(to);
  std::erase_if(patches_, [&](const auto& entry) {
    const VoxelKey& cell = entry.first;
    if (cell.x < first.x || cell.x > last.x || cell.y < first.y || cell.y > last.y ||
        cell.z < first.z || cell.z > last.z)
      return false;
    const auto it = sums.find(cell);
    const bool is_lost = it == sums.end() || !is_patch(it->second);
    if (is_lost) lost_[cell] = entry.second;
    return is_lost;
  });
  for (const auto& [cell, sum] : sums) {
    if (!is_patch(sum)) continue;
    const auto lost = lost_.find(cell);
    SearchPatch& patch =
        patches_.try_emplace(cell, lost == lost_.end() ? SearchPatch{} : lost->second)
            .first->second;
    patch.p_world = sum.p_world / sum.count + Vector3d(0, 0, 0.5 * voxel_m);
    patch.height_m = patch.p_world.z() - level_m;
    patch.columns = sum.count;
  }
}

void SearchField::Look(const Observation& obs, double range_m) {
  const Pose T_camera_world = obs.T_world_camera.inverse();
  for (auto& [cell, patch] : patches_) {
    LookAt(T_camera_world * patch.LowPoint(), obs, range_m, &patch.low);
    LookAt(T_camera_world * patch.HighPoint(), obs, range_m, &patch.high);
  }
}

void SearchField::BeginGoal() {
  for (auto* patches : {&patches_, &lost_})
    for (auto& [cell, patch] : *patches)
      patch.low.for_goal_m = patch.high.for_goal_m = Looked{}.for_goal_m;
}

int ColumnsAround(const SearchField& field, const VoxelKey& cell) {
  const double z_m = field.patches().at(cell).p_world.z();
  int columns = 0;
  ForEachAround(field.patches(), cell, [&](const SearchPatch& patch) {
    if (std::abs(patch.p_world.z() - z_m) <= kLevel_m) columns += patch.columns;
  });
  return columns;
}

}  // namespace crossnav::policy
