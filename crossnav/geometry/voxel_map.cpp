// SPDX-License-Identifier: MIT
#include "crossnav/geometry/voxel_map.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/core/check.h"
#include "crossnav/geometry/classify.h"
#include "crossnav/geometry/flying_pixels.h"
#include "crossnav/geometry/frame.h"
#include "crossnav/geometry/grazing_surface.h"
#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/map_data.h"
#include "crossnav/geometry/tread_sight.h"

namespace crossnav::geometry {

namespace {
constexpr double kFarthest_m = 1e6;  // chosen: far beyond any house, far within a voxel index
}  // namespace

MapCells CellsOf(const MapConfig& config) {
  MapCells cells;
  cells.support_depth = CellsFloor(config.support_depth_m, config.voxel_m);
  cells.max_climb = CellsFloor(config.max_climb_m, config.voxel_m);
  cells.agent_height = CellsFloor(config.agent_height_m, config.voxel_m);
  cells.inflation = config.inflation_m / config.voxel_m + kCellTolerance;
  cells.extent_xy = CellsFloor(config.extent_xy_m / 2, config.voxel_m);
  cells.extent_z = CellsFloor(config.extent_z_m / 2, config.voxel_m);
  return cells;
}

MapData& MapAccess::Of(VoxelMap& map) {
  return *map.data_;
}
const MapData& MapAccess::Of(const VoxelMap& map) {
  return *map.data_;
}

VoxelMap::VoxelMap(const MapConfig& config) : data_(std::make_unique<MapData>()) {
  data_->config = config;
  data_->cells = CellsOf(config);
}
VoxelMap::~VoxelMap() = default;
VoxelMap::VoxelMap(VoxelMap&&) noexcept = default;
VoxelMap& VoxelMap::operator=(VoxelMap&&) noexcept = default;

const MapConfig& VoxelMap::config() const {
  return data_->config;
}
const SparseGrid<VoxelBlock>& VoxelMap::grid() const {
  return data_->grid;
}
std::uint64_t VoxelMap::Revision() const {
  return data_->revision;
}

const EndVoxels& VoxelMap::Integrate(const DepthImage& depth_m, const CameraIntrinsics& camera,
                                     const Pose& T_world_camera) {
  CROSSNAV_CHECK(T_world_camera.matrix().allFinite() &&
                     T_world_camera.translation().cwiseAbs().maxCoeff() < kFarthest_m,
                 "the pose must be finite and within voxel indices");
  CROSSNAV_CHECK(depth_m.width == camera.width_px && depth_m.height == camera.height_px,
                 "depth image and camera differ in size");
  const bool is_real = data_->config.clearing == "evidence";  // a sensor with noise
  const DepthImage confirmed_m =
      is_real ? WithoutFlyingPixels(depth_m, config().min_neighbours) : DepthImage{};
  const DepthFrame frame{is_real ? confirmed_m : depth_m, camera, T_world_camera};
  if (!data_->center) data_->center = KeyOf(T_world_camera.translation(), config().voxel_m);
  data_->view.Resize(depth_m.width, depth_m.height);
  const KeyBounds bounds = CollectEnds(*data_, frame);
  if (IsProjectionCheaper(*data_, frame))
    CollectFreeByProjection(*data_, frame, bounds);
  else
    CollectFreeByWalking(*data_, frame);
  if (is_real) {
    SpareTreads(*data_, frame);
    SpareSurfacesInGaps(*data_, frame);
  }
  MergeFrame(*data_);
  return data_->ends;
}

namespace {

/// The column in which the agent stands: its real surface close to the foot, or else the voxel that
/// is taken for it. A foot on a voxel face, to rounding, stands on the voxel below the face.
struct FootSupport {
  int z = 0;
  bool is_real = false;
};

constexpr double kFootTolerance_m =
    0.02;                                 // chosen: a foot this little above a face stands below it
constexpr double kFootSearchUp_m = 0.05;  // chosen: navmesh and floor differ by less than this
constexpr double kFootSearchDown_m = 0.25;  // chosen: likewise, where the foot hovers

FootSupport FindFootSupport(const MapData& map, const Vector3d& p_world_foot) {
  const double voxel_m = map.config.voxel_m;
  const VoxelKey foot = KeyOf(p_world_foot, voxel_m);
  const auto z_of = [&](double z_m) { return static_cast<int>(std::floor(z_m / voxel_m)); };
  const int top = z_of(p_world_foot.z() + kFootSearchUp_m);
  for (int z = top; z >= z_of(p_world_foot.z() - kFootSearchDown_m); --z) {
    const VoxelKey key{foot.x, foot.y, z};
    const VoxelBlock* block = map.grid.Find(BlockKeyOf(key));
    if (block != nullptr && block->hit.Test(CellIndexOf(key))) return {z, true};
  }
  return {z_of(p_world_foot.z() - kFootTolerance_m), false};
}

void SetBodyFree(MapData& map, const VoxelKey& key) {
  if (!IsKept(map, key)) return;
  GridEntry& entry = map.grid.TouchEntry(BlockKeyOf(key));
  VoxelBlock& block = entry.block;
  const int cell = CellIndexOf(key);
  if (block.hit.Test(cell)) return;
  if (block.agent_support.Test(cell)) {
    block.agent_support.Reset(cell);
    block.changed_surface.Set(cell);
    ListChanged(map, entry);
  }
  if (block.free.Test(cell)) return;
  block.free.Set(cell);
  block.changed_free.Set(cell);
  ListChanged(map, entry);
}

void SetAgentSupport(MapData& map, const VoxelKey& key) {
  if (!IsKept(map, key)) return;
  GridEntry& entry = map.grid.TouchEntry(BlockKeyOf(key));
  const int cell = CellIndexOf(key);
  if (entry.block.Surface().Test(cell)) return;
  entry.block.agent_support.Set(cell);
  entry.block.changed_surface.Set(cell);
  ListChanged(map, entry);
}

}  // namespace

void VoxelMap::ObserveBody(const Vector3d& p_world_foot, double camera_height_m) {
  CROSSNAV_CHECK(p_world_foot.allFinite(), "the foot must be finite");
  MapData& map = *data_;
  const double voxel_m = map.config.voxel_m, radius_m = map.config.agent_radius_m;
  const VoxelKey foot = KeyOf(p_world_foot, voxel_m);
  const FootSupport support = FindFootSupport(map, p_world_foot);
  const int top = KeyOf(p_world_foot + Vector3d(0, 0, camera_height_m), voxel_m).z;
  const int reach = CellsCeil(radius_m, voxel_m);
  for (int y = foot.y - reach; y <= foot.y + reach; ++y) {
    for (int x = foot.x - reach; x <= foot.x + reach; ++x) {
      const Vector3d offset = CenterOf({x, y, foot.z}, voxel_m) - p_world_foot;
      const bool is_own = x == foot.x && y == foot.y;
      if (!is_own && offset.head<2>().norm() > radius_m) continue;
      for (int z = support.z + 1; z <= top; ++z) SetBodyFree(map, {x, y, z});
    }
  }
  if (!support.is_real) SetAgentSupport(map, {foot.x, foot.y, support.z});
}

void VoxelMap::MarkStair(const std::vector<VoxelKey>& keys, StairMark mark) {
  const auto bits = static_cast<unsigned>(mark);
  const auto write = [](BlockMask& mask, int cell, bool value) {
    value ? mask.Set(cell) : mask.Reset(cell);
  };
  for (const VoxelKey& key : keys) {
    GridEntry* entry = data_->grid.FindEntry(BlockKeyOf(key));
    if (entry == nullptr) continue;
    VoxelBlock& block = entry->block;
    const int cell = CellIndexOf(key);
    const unsigned old = block.stair_low.Test(cell) | block.stair_high.Test(cell) << 1;
    if (old == bits || (mark != StairMark::kNone && !block.Surface().Test(cell))) continue;
    write(block.stair_low, cell, bits & 1);
    write(block.stair_high, cell, bits & 2);
    block.changed_surface.Set(cell);
    ListChanged(*data_, *entry);
  }
}

const std::vector<StateChange>& VoxelMap::UpdateStates() {
  MapData& map = *data_;
  map.changes.clear();
  for (GridEntry* entry : TakeStaleBlocks(map)) ClassifyBlock(map, *entry, &map.changes);
  SortChanges(&map.changes);
  if (!map.changes.empty()) ++map.revision;
  return map.changes;
}

}  // namespace crossnav::geometry
