// SPDX-License-Identifier: MIT
// The support-aware sparse voxel map (paper, "Support-Aware 3D Voxel Mapping"). Evidence (hit,
// ray-observed free, stair evidence) is kept apart from the state derived from it; states are
// brought up to date locally by UpdateStates() and equal a full rebuild.
// World frame, metres. Any number of readers while nobody writes; no internal locking.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/geometry/end_voxel_list.h"
#include "crossnav/geometry/map_config.h"
#include "crossnav/geometry/voxel_block.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/geometry/voxel_states.h"

namespace crossnav::geometry {

/// Stair evidence laid over an OCCUPIED voxel.
enum class StairMark : std::uint8_t { kNone = 0, kStair = 1, kExpanded = 2, kFake = 3 };

/// One derived state that changed in the last UpdateStates().
struct StateChange {
  VoxelKey key;
  Voxel voxel;
};

struct MapStats {
  std::int64_t known = 0, occupied = 0, traversable = 0, blocks = 0;
  std::int64_t bytes = 0;  ///< memory held by the map
};

struct MapData;
struct MapAccess;

class VoxelMap {
 public:
  explicit VoxelMap(const MapConfig& config = {});
  ~VoxelMap();
  VoxelMap(VoxelMap&&) noexcept;
  VoxelMap& operator=(VoxelMap&&) noexcept;

  const MapConfig& config() const;

  // --- Writing evidence -----------------------------------------------------------------------

  /// End voxels of valid depth pixels become occupied, voxels before them ray-observed free.
  /// `depth_m` H x W planar metres. Returns the end voxel of every valid pixel within depth limits
  /// (memory lifts features through it); valid until the next call.
  const EndVoxels& Integrate(const DepthImage& depth_m, const CameraIntrinsics& camera,
                             const Pose& T_world_camera);

  /// The agent's own cylinder is free from foot to camera; the voxel under the foot supports it.
  void ObserveBody(const Vector3d& p_world_foot, double camera_height_m);

  /// Lays stair evidence over surface voxels (kNone takes it away). Keys that are not surfaces are
  /// ignored.
  void MarkStair(const std::vector<VoxelKey>& keys, StairMark mark);

  /// Brings derived states up to date where evidence changed since the last call.
  /// eq:supp_support_classification and inflation. Changes are sorted by key.
  const std::vector<StateChange>& UpdateStates();

  // --- Reading --------------------------------------------------------------------------------

  Voxel At(const VoxelKey& key) const;  ///< kUnknown where nothing was observed
  VoxelState StateAt(const VoxelKey& key) const { return At(key).state; }
  StairMark StairMarkAt(const VoxelKey& key) const;
  bool IsObserved(const VoxelKey& key) const { return StateAt(key) != VoxelState::kUnknown; }

  /// Visits every observed voxel, block by block in order of first observation.
  void ForEach(const std::function<void(const VoxelKey&, const Voxel&)>& visit) const;

  /// Observed voxels with lo <= key <= hi on every axis, x fastest.
  void ForEachInBox(const VoxelKey& lo, const VoxelKey& hi,
                    const std::function<void(const VoxelKey&, const Voxel&)>& visit) const;

  /// Observed voxels with z_lo <= z <= z_hi, block by block. Cost O(blocks + voxels in the slab).
  void ForEachInSlab(int z_lo, int z_hi,
                     const std::function<void(const VoxelKey&, const Voxel&)>& visit) const;

  /// First surface voxel below `key` within the support depth, or false.
  bool FindSupport(const VoxelKey& key, VoxelKey* support) const;

  /// Pathable, targetable, not inflated voxel nearest to `p_world` within `radius_m`; ties by key.
  bool NearestFree(const Vector3d& p_world, double radius_m, VoxelKey* found) const;

  /// True if no surface voxel lies strictly between the two points' voxels.
  bool HasLineOfSight(const Vector3d& a_world, const Vector3d& b_world) const;

  /// The same, with at most `most_unseen` unobserved voxels in between.
  bool IsSeenThrough(const Vector3d& a_world, const Vector3d& b_world, int most_unseen) const;

  MapStats Stats() const;

  /// Grows with every change of a derived state; equal values mean an unchanged map.
  std::uint64_t Revision() const;

  /// Reads with the last block remembered; the fast way to look at neighbours. One per thread;
  /// stale after the map was written.
  class Cursor {
   public:
    explicit Cursor(const VoxelMap& map) : reader_(map.grid()) {}
    Voxel At(const VoxelKey& key) {
      const VoxelBlock* block = reader_.Find(key);
      return block ? DecodeCell(block->cells[CellIndexOf(key)]) : Voxel{};
    }

   private:
    GridReader<VoxelBlock> reader_;
  };

 private:
  friend struct MapAccess;
  const SparseGrid<VoxelBlock>& grid() const;

  std::unique_ptr<MapData> data_;
};

}  // namespace crossnav::geometry
