// SPDX-License-Identifier: MIT
// The ground: every place where a foot can be put, on all floors, landings and treads at
// once. Geometry alone decides: a place needs a rise within the climb limit, head-room, and
// room for the body; stair masks have no say. The name of a place is its lowest free voxel;
// its support is the surface voxel below. State changes of the map update it; a lookup costs
// a few word operations per column. World frame; lengths in voxels. Not thread-safe with
// Update.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <unordered_set>
#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/planner/ground_places.h"

namespace crossnav::planner {

/// Outcome of a step from a place to a neighbouring column.
enum class StepOutcome : std::uint8_t {
  kGround,   ///< a place to stand within the climb limit
  kBlocked,  ///< something that stops the body
  kUnknown,  ///< unobserved; ground is possible
  kDrop,     ///< air seen deeper than the climb limit, or ground without an answer
};

class GroundMap {
 public:
  explicit GroundMap(const geometry::MapConfig& config);

  void Update(const std::vector<geometry::StateChange>& changes);
  void Rebuild(const geometry::VoxelMap& map);

  /// Surface below, free air here, head-room above, and no obstacle known from a bump.
  bool IsStanding(const VoxelKey& key) const;

  /// The place to stand in column (x, y) nearest in height to `z`, within `reach` voxels.
  std::optional<int> StandingNear(int x, int y, int z, int reach) const;

  /// The place to stand nearest to a foot within half a metre; nullopt where there is none.
  std::optional<VoxelKey> StandingAt(const Vector3d& p_world_foot) const;

  /// Outcome of the step from `key` to the column at (dx, dy); `ground_z` gets its height.
  StepOutcome OutcomeOf(const VoxelKey& key, int dx, int dy, int* ground_z) const;

  /// The next place straight ahead across unobserved columns or columns seen as air: a tread hidden
  /// behind its riser, or an open riser. At most `reach` columns away, within the climb limit,
  /// without an obstacle to the body in between.
  std::optional<VoxelKey> Bridge(const VoxelKey& key, int dx, int dy, int reach) const;

  /// Rise from a foot at height `key.z` to the ground of its column: to the place there, or to the
  /// riser where the tread is unobserved; 0 = nothing seen, nullopt = a wall.
  std::optional<int> RiseAt(const VoxelKey& key) const;

  Clearance ClearanceOf(const VoxelKey& key) const;

  /// Distance from the upright axis at `p_world_foot` to the nearest column that stops a body
  /// standing at height `z`, at most `cap_m` [m].
  double DistanceToObstacle(const Vector3d& p_world_foot, int z, double cap_m) const;

  /// Marks the column under `p_world` as an obstacle at that height, until ForgetBlocked. False if
  /// it was marked already.
  bool Block(const Vector3d& p_world);
  void ForgetBlocked();
  /// Forgets the marks within `radius_m`. False if there were none.
  bool ForgetBlockedAround(const Vector3d& p_world, double radius_m);
  bool HasBlocked() const { return !blocked_.empty(); }

  /// Marks the column of `key` as ground without an answer: unobserved space there, at about that
  /// height, is no frontier.
  void NoteUnanswered(const VoxelKey& key);

  /// Notes a step of the body between two foot positions. Rises along it are steps from then on, in
  /// both directions.
  void NoteStep(const Vector3d& p_from_world, const Vector3d& p_to_world);
  bool WasWalked(const VoxelKey& key) const { return walked_.contains(key); }

  int climb() const { return climb_; }
  int radius() const { return radius_; }  ///< of the body, at least 1
  /// Columns in direction (dx, dy) that the deepest tread may take.
  int BridgeReach(int dx, int dy) const { return dx != 0 && dy != 0 ? diagonal_bridge_ : bridge_; }
  double voxel_m() const { return voxel_m_; }
  /// Grows with every change of the ground.
  std::uint64_t revision() const { return revision_; }
  /// The revision of the last change that the places of column (x, y) may depend on.
  std::uint64_t ChangedAt(int x, int y) const {
    const Tile* tile = FindTile(x, y);
    return tile ? tile->changed_at : revision_;
  }
  /// The same of all columns within `reach` of it.
  std::uint64_t ChangedAround(int x, int y, int reach) const;
  /// Cache that searches fill; its answers depend on the ground alone. One thread at a time.
  GroundPlaces& places() const { return places_; }

 private:
  static constexpr int kTileSide = 8;
  /// 8 x 8 columns, each a run of 64-bit words: a word for surfaces, a word for seen air.
  struct Tile {
    int first_word = 0;
    int words = 0;
    std::vector<std::uint64_t> surface, air;  // [column][word]
    std::uint64_t changed_at = 0;             // revision
  };

  /// -1 = none.
  std::int32_t TileAt(int x, int y) const {
    const int column = (x >> 3) - first_x_, row = (y >> 3) - first_y_;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
    return index_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }
  const Tile* FindTile(int x, int y) const {
    const std::int32_t tile = TileAt(x, y);
    return tile < 0 ? nullptr : &tiles_[static_cast<std::size_t>(tile)];
  }
  Tile& TouchTile(int x, int y);
  void Set(const VoxelKey& key, bool is_surface, bool is_air);
  void Clear();
  /// Notes a change of column (x, y), for the next revision.
  void Touch(int x, int y);
  /// Bits z_lo .. z_lo + 63 of the column.
  static std::uint64_t Window(const Tile& tile, const std::vector<std::uint64_t>& bits, int column,
                              int z_lo);
  std::uint64_t Surfaces(int x, int y, int z_lo) const;
  std::uint64_t Air(int x, int y, int z_lo) const;
  std::uint64_t StandingBits(int x, int y, int z_lo) const;
  bool IsBodyBlocked(int x, int y, int z) const;
  /// OutcomeOf by surfaces and air alone.
  StepOutcome SeenOutcomeOf(const VoxelKey& key, int dx, int dy, int* ground_z) const;

  double voxel_m_;
  int climb_, height_, inflation_, radius_, bridge_, diagonal_bridge_;
  // Window around the existing tiles: index into `tiles_`, -1 = none.
  std::vector<std::int32_t> index_;
  int first_x_ = 0, first_y_ = 0, columns_ = 0, rows_ = 0;  // [tiles]
  std::vector<Tile> tiles_;
  std::set<VoxelKey> blocked_;
  std::set<VoxelKey> walked_;  // places on rises that the body walked
  std::unordered_set<VoxelKey, geometry::VoxelKeyHash> unanswered_;
  std::uint64_t revision_ = 0;
  mutable GroundPlaces places_;
};

}  // namespace crossnav::planner
