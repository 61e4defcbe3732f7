// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "crossnav/core/cells.h"

namespace crossnav::planner {
namespace {

using geometry::IsSurface;
using geometry::VoxelState;

constexpr int kBelow = 8;          // voxels of a window below its place
constexpr int kHeadSlack = 1;      // chosen: a ceiling may start one voxel low
constexpr int kSeenAir = 2;        // chosen: above a surface; one voxel may be a ray along a wall
constexpr double kBridge_m = 0.4;  // chosen: the deepest tread
constexpr double kFootReach_m = 0.5;  // chosen: an agent is never farther from its floor

int ColumnOf(int x, int y) {
  return (y & 7) * 8 + (x & 7);
}
/// Bits lo .. hi, both included.
constexpr std::uint64_t Span(int lo, int hi) {
  return hi < lo ? 0 : (~std::uint64_t{0} >> (63 - (hi - lo))) << lo;
}

}  // namespace

GroundMap::GroundMap(const geometry::MapConfig& config)
    : voxel_m_(config.voxel_m),
      climb_(CellsFloor(config.max_climb_m, config.voxel_m)),
      height_(std::min(CellsFloor(config.agent_height_m, config.voxel_m), 63 - kBelow)),
      inflation_(CellsFloor(config.inflation_m, config.voxel_m)),
      radius_(std::max(1, CellsFloor(config.agent_radius_m, config.voxel_m))),
      bridge_(std::max(1, CellsFloor(kBridge_m, config.voxel_m))),
      diagonal_bridge_(std::max(1, CellsNearest(kBridge_m, config.voxel_m * std::numbers::sqrt2))) {
}

GroundMap::Tile& GroundMap::TouchTile(int x, int y) {
  constexpr int kMargin = 8;  // tiles of room on each side, so that growing is rare
  const int tx = x >> 3, ty = y >> 3;
  const bool is_inside =
      tx >= first_x_ && ty >= first_y_ && tx < first_x_ + columns_ && ty < first_y_ + rows_;
  if (!is_inside) {
    const bool is_first = index_.empty();
    const int x0 = is_first ? tx - kMargin : std::min(first_x_, tx - kMargin);
    const int y0 = is_first ? ty - kMargin : std::min(first_y_, ty - kMargin);
    const int x1 = is_first ? tx + kMargin : std::max(first_x_ + columns_, tx + kMargin);
    const int y1 = is_first ? ty + kMargin : std::max(first_y_ + rows_, ty + kMargin);
    std::vector<std::int32_t> grown(
        static_cast<std::size_t>(x1 - x0 + 1) * static_cast<std::size_t>(y1 - y0 + 1), -1);
    for (int row = 0; row < rows_; ++row)
      std::copy_n(index_.begin() + static_cast<std::ptrdiff_t>(row) * columns_, columns_,
                  grown.begin() + static_cast<std::ptrdiff_t>(row + first_y_ - y0) * (x1 - x0 + 1) +
                      (first_x_ - x0));
    index_ = std::move(grown);
    first_x_ = x0;
    first_y_ = y0;
    columns_ = x1 - x0 + 1;
    rows_ = y1 - y0 + 1;
  }
  std::int32_t& tile =
      index_[static_cast<std::size_t>(ty - first_y_) * static_cast<std::size_t>(columns_) +
             static_cast<std::size_t>(tx - first_x_)];
  if (tile < 0) {
    tile = static_cast<std::int32_t>(tiles_.size());
    tiles_.emplace_back();
  }
  return tiles_[static_cast<std::size_t>(tile)];
}

void GroundMap::Clear() {
  index_.clear();
  tiles_.clear();
  columns_ = rows_ = 0;
  places_ = {};
  ++revision_;
}

void GroundMap::Touch(int x, int y) {
  const int reach = std::max(bridge_, inflation_);
  for (int ty = (y - reach) >> 3; ty <= (y + reach) >> 3; ++ty)
    for (int tx = (x - reach) >> 3; tx <= (x + reach) >> 3; ++tx)
      if (const std::int32_t tile = TileAt(tx * kTileSide, ty * kTileSide); tile >= 0)
        tiles_[static_cast<std::size_t>(tile)].changed_at = revision_ + 1;
}

void GroundMap::Set(const VoxelKey& key, bool is_surface, bool is_air) {
  Tile& tile = TouchTile(key.x, key.y);
  const int word = key.z >> 6;
  const int lo = tile.words ? std::min(tile.first_word, word) : word;
  const int hi = tile.words ? std::max(tile.first_word + tile.words - 1, word) : word;
  if (hi - lo + 1 != tile.words) {
    Tile grown{lo, hi - lo + 1, {}, {}, tile.changed_at};
    grown.surface.resize(std::size_t{kTileSide * kTileSide} *
                         static_cast<std::size_t>(grown.words));
    grown.air.resize(grown.surface.size());
    for (int column = 0; column < kTileSide * kTileSide; ++column)
      for (int w = 0; w < tile.words; ++w) {
        const int to = column * grown.words + w + tile.first_word - lo;
        const int from = column * tile.words + w;
        grown.surface[static_cast<std::size_t>(to)] = tile.surface[static_cast<std::size_t>(from)];
        grown.air[static_cast<std::size_t>(to)] = tile.air[static_cast<std::size_t>(from)];
      }
    tile = std::move(grown);
    Touch(key.x, key.y);
  }
  const auto at =
      static_cast<std::size_t>(ColumnOf(key.x, key.y) * tile.words + word - tile.first_word);
  const std::uint64_t bit = std::uint64_t{1} << (key.z & 63);
  const std::uint64_t surface = is_surface ? tile.surface[at] | bit : tile.surface[at] & ~bit;
  const std::uint64_t air = is_air ? tile.air[at] | bit : tile.air[at] & ~bit;
  if (surface == tile.surface[at] && air == tile.air[at]) return;
  tile.surface[at] = surface;
  tile.air[at] = air;
  Touch(key.x, key.y);
}

void GroundMap::Update(const std::vector<geometry::StateChange>& changes) {
  for (const auto& change : changes) {
    const VoxelState state = change.voxel.state;
    const bool is_surface = IsSurface(state);
    Set(change.key, is_surface, !is_surface && state != VoxelState::kUnknown);
  }
  if (!changes.empty()) ++revision_;
}

std::uint64_t GroundMap::ChangedAround(int x, int y, int reach) const {
  std::uint64_t changed = 0;
  for (int ty = (y - reach) >> 3; ty <= (y + reach) >> 3; ++ty)
    for (int tx = (x - reach) >> 3; tx <= (x + reach) >> 3; ++tx)
      if (const std::int32_t tile = TileAt(tx * kTileSide, ty * kTileSide); tile >= 0)
        changed = std::max(changed, tiles_[static_cast<std::size_t>(tile)].changed_at);
  return changed;
}

void GroundMap::Rebuild(const geometry::VoxelMap& map) {
  Clear();
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    Set(key, IsSurface(voxel.state), !IsSurface(voxel.state));
  });
  ++revision_;
}

std::uint64_t GroundMap::Window(const Tile& tile, const std::vector<std::uint64_t>& bits,
                                int column, int z_lo) {
  const int word = (z_lo >> 6) - tile.first_word, shift = z_lo & 63;
  const auto at = [&](int w) {
    const int index = column * tile.words + w;
    return w < 0 || w >= tile.words ? 0 : bits[static_cast<std::size_t>(index)];
  };
  return shift == 0 ? at(word) : at(word) >> shift | at(word + 1) << (64 - shift);
}

std::uint64_t GroundMap::Surfaces(int x, int y, int z_lo) const {
  const Tile* tile = FindTile(x, y);
  return tile ? Window(*tile, tile->surface, ColumnOf(x, y), z_lo) : 0;
}
std::uint64_t GroundMap::Air(int x, int y, int z_lo) const {
  const Tile* tile = FindTile(x, y);
  return tile ? Window(*tile, tile->air, ColumnOf(x, y), z_lo) : 0;
}

/// Bit i: z_lo + i is a place to stand. Valid for the lower half of the window.
std::uint64_t GroundMap::StandingBits(int x, int y, int z_lo) const {
  const Tile* tile = FindTile(x, y);
  if (tile == nullptr) return 0;
  const int column = ColumnOf(x, y);
  const std::uint64_t air = Window(*tile, tile->air, column, z_lo);
  const std::uint64_t below = Window(*tile, tile->surface, column, z_lo - 1);
  std::uint64_t standing = air & below;
  for (int i = 1; i < kSeenAir; ++i) standing &= air >> i;
  if (standing == 0) return 0;
  const std::uint64_t surface = Window(*tile, tile->surface, column, z_lo);
  for (std::uint64_t rest = standing; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const int top = std::min(63, i + height_ - 1 - kHeadSlack);
    const bool is_bumped = !blocked_.empty() && blocked_.contains({x, y, z_lo + i});
    if ((surface & Span(i, top)) != 0 || is_bumped) standing &= ~(std::uint64_t{1} << i);
  }
  return standing;
}

bool GroundMap::IsStanding(const VoxelKey& key) const {
  return (StandingBits(key.x, key.y, key.z) & 1) != 0;
}

std::optional<int> GroundMap::StandingNear(int x, int y, int z, int reach) const {
  const std::uint64_t bits = StandingBits(x, y, z - reach);
  for (int d = 0; d <= reach; ++d) {
    if ((bits >> (reach + d) & 1) != 0) return z + d;
    if ((bits >> (reach - d) & 1) != 0) return z - d;
  }
  return std::nullopt;
}

std::optional<VoxelKey> GroundMap::StandingAt(const Vector3d& p_world_foot) const {
  const VoxelKey center = geometry::KeyOf(p_world_foot + Vector3d(0, 0, 0.5 * voxel_m_), voxel_m_);
  const int reach = CellsFloor(kFootReach_m, voxel_m_);
  std::optional<VoxelKey> best;
  double best_vox = 1e9;
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      const auto z = StandingNear(center.x + dx, center.y + dy, center.z, reach);
      if (!z) continue;
      const VoxelKey key{center.x + dx, center.y + dy, *z};
      const Vector3d d = (CenterOf(key, voxel_m_) - p_world_foot) / voxel_m_;
      const double distance = std::hypot(d.x(), d.y(), d.z() - 0.5);
      if (distance >= best_vox - 1e-9) continue;
      best = key;
      best_vox = distance;
    }
  return best;
}

/// Obstacle higher than the climb limit within the body of an agent standing at height `z`.
bool GroundMap::IsBodyBlocked(int x, int y, int z) const {
  const std::uint64_t surface = Surfaces(x, y, z - kBelow);
  if ((surface & Span(kBelow + climb_, kBelow + height_ - 1 - kHeadSlack)) != 0) return true;
  return !blocked_.empty() && blocked_.contains({x, y, z});
}

StepOutcome GroundMap::OutcomeOf(const VoxelKey& key, int dx, int dy, int* ground_z) const {
  const StepOutcome outcome = SeenOutcomeOf(key, dx, dy, ground_z);
  if (outcome != StepOutcome::kUnknown || unanswered_.empty()) return outcome;
  return unanswered_.contains({key.x + dx, key.y + dy, key.z}) ? StepOutcome::kDrop : outcome;
}

StepOutcome GroundMap::SeenOutcomeOf(const VoxelKey& key, int dx, int dy, int* ground_z) const {
  const int x = key.x + dx, y = key.y + dy;
  const Tile* tile = FindTile(x, y);
  if (tile == nullptr) return StepOutcome::kUnknown;
  if (IsBodyBlocked(x, y, key.z)) return StepOutcome::kBlocked;
  if (const auto z = StandingNear(x, y, key.z, climb_)) {
    // A step up needs head-room at its start as well.
    const std::uint64_t own = Surfaces(key.x, key.y, key.z - kBelow);
    const int top = kBelow + std::max(0, *z - key.z) + height_ - 1 - kHeadSlack;
    if ((own & Span(kBelow, std::min(63, top))) != 0) return StepOutcome::kBlocked;
    *ground_z = *z;
    return StepOutcome::kGround;
  }
  // Search down from the highest observed air within the climb limit for the first other voxel.
  const std::uint64_t air = Air(x, y, key.z - kBelow), surface = Surfaces(x, y, key.z - kBelow);
  const int lowest = kBelow - climb_ - 1;
  int at = kBelow + climb_;
  while (at >= kBelow && (air >> at & 1) == 0) --at;
  // Without air a surface decides nothing: below, it may be the ceiling of the storey underneath;
  // within the climb limit, the riser of a hidden tread.
  if (at < kBelow) return StepOutcome::kUnknown;
  while (at >= lowest && (air >> at & 1) != 0) --at;
  if (at < lowest) return StepOutcome::kDrop;
  if ((surface >> at & 1) == 0) return StepOutcome::kUnknown;
  // A surface under too little observed air is possible ground; under an obstacle it is not.
  const bool is_seen = (air >> (at + 1) & Span(0, kSeenAir - 1)) == Span(0, kSeenAir - 1);
  const bool is_under = (surface & Span(at + 1, std::min(63, at + height_ - kHeadSlack))) != 0;
  const bool is_bumped = !blocked_.empty() && blocked_.contains({x, y, key.z - kBelow + at + 1});
  return is_seen || is_under || is_bumped ? StepOutcome::kBlocked : StepOutcome::kUnknown;
}

std::optional<VoxelKey> GroundMap::Bridge(const VoxelKey& key, int dx, int dy, int reach) const {
  for (int k = 1; k <= reach; ++k) {
    int z = 0;
    switch (OutcomeOf(key, k * dx, k * dy, &z)) {
      case StepOutcome::kBlocked:
        return std::nullopt;
      case StepOutcome::kGround:
        return VoxelKey{key.x + k * dx, key.y + k * dy, z};
      case StepOutcome::kUnknown:
      case StepOutcome::kDrop:
        break;
    }
  }
  return std::nullopt;
}

std::optional<int> GroundMap::RiseAt(const VoxelKey& key) const {
  if (IsBodyBlocked(key.x, key.y, key.z)) return std::nullopt;
  if (const auto z = StandingNear(key.x, key.y, key.z, climb_)) return *z - key.z;
  const std::uint64_t front = Surfaces(key.x, key.y, key.z) & Span(0, climb_ - 1);
  return std::bit_width(front);
}

Clearance GroundMap::ClearanceOf(const VoxelKey& key) const {
  constexpr std::array<VoxelKey, 4> kAxes = {{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, -1, 0}}};
  bool is_touching = false;
  for (const VoxelKey& d : kAxes) {
    const bool ahead = IsBodyBlocked(key.x + d.x, key.y + d.y, key.z);
    const bool behind = IsBodyBlocked(key.x - d.x, key.y - d.y, key.z);
    if (ahead && behind) return Clearance::kPinch;
    is_touching = is_touching || ahead || behind;
  }
  if (is_touching) return Clearance::kTouch;
  for (int dy = -inflation_; dy <= inflation_; ++dy)
    for (int dx = -inflation_; dx <= inflation_; ++dx) {
      if (std::abs(dx) <= 1 && std::abs(dy) <= 1) continue;
      if (dx * dx + dy * dy > inflation_ * inflation_ + 1) continue;
      if (IsBodyBlocked(key.x + dx, key.y + dy, key.z)) return Clearance::kTight;
    }
  return Clearance::kFree;
}

double GroundMap::DistanceToObstacle(const Vector3d& p_world_foot, int z, double cap_m) const {
  const VoxelKey foot = geometry::KeyOf(p_world_foot, voxel_m_);
  const int reach = CellsCeil(cap_m, voxel_m_);
  double nearest = cap_m;
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      const double x = (foot.x + dx) * voxel_m_, y = (foot.y + dy) * voxel_m_;
      const double ox = std::max({x - p_world_foot.x(), 0.0, p_world_foot.x() - x - voxel_m_});
      const double oy = std::max({y - p_world_foot.y(), 0.0, p_world_foot.y() - y - voxel_m_});
      const double distance = std::hypot(ox, oy);
      if (distance < nearest && IsBodyBlocked(foot.x + dx, foot.y + dy, z)) nearest = distance;
    }
  return nearest;
}

bool GroundMap::Block(const Vector3d& p_world) {
  const VoxelKey key = geometry::KeyOf(p_world, voxel_m_);
  // From one climb below to two above: a bump does not tell the obstacle's height.
  bool is_new = false;
  for (int dz = -climb_; dz <= 2 * climb_ + 1; ++dz)
    is_new = blocked_.insert({key.x, key.y, key.z + dz}).second || is_new;
  if (!is_new) return false;
  Touch(key.x, key.y);
  ++revision_;
  return true;
}

void GroundMap::ForgetBlocked() {
  for (const VoxelKey& key : blocked_) Touch(key.x, key.y);
  blocked_.clear();
  ++revision_;
}

bool GroundMap::ForgetBlockedAround(const Vector3d& p_world, double radius_m) {
  const auto forgotten = std::erase_if(blocked_, [&](const VoxelKey& key) {
    const bool is_near = (geometry::CenterOf(key, voxel_m_) - p_world).norm() <= radius_m;
    if (is_near) Touch(key.x, key.y);
    return is_near;
  });
  if (forgotten > 0) ++revision_;
  return forgotten > 0;
}

void GroundMap::NoteUnanswered(const VoxelKey& key) {
  bool is_new = false;
  for (int dz = -climb_; dz <= climb_; ++dz)
    is_new = unanswered_.insert({key.x, key.y, key.z + dz}).second || is_new;
  if (!is_new) return;
  Touch(key.x, key.y);
  ++revision_;
}

void GroundMap::NoteStep(const Vector3d& p_from_world, const Vector3d& p_to_world) {
  const Vector3d offset = p_to_world - p_from_world;
  if (std::abs(offset.z()) < kDoorstep_m) return;
  const int samples = CellsCeil(2 * offset.head<2>().norm(), voxel_m_) + 1;
  const auto height_of = [this](double z_m) { return CellsNearest(z_m, voxel_m_); };
  const int lo = height_of(std::min(p_from_world.z(), p_to_world.z())) - 1;
  const int hi = height_of(std::max(p_from_world.z(), p_to_world.z())) + 1;
  bool is_new = false;
  for (int i = 0; i <= samples; ++i) {
    const VoxelKey at = geometry::KeyOf(p_from_world + offset * i / samples, voxel_m_);
    for (int x = at.x - radius_; x <= at.x + radius_; ++x)
      for (int y = at.y - radius_; y <= at.y + radius_; ++y) {
        bool is_new_here = false;
        for (int z = lo; z <= hi; ++z) is_new_here |= walked_.insert({x, y, z}).second;
        if (is_new_here) Touch(x, y);
        is_new = is_new || is_new_here;
      }
  }
  if (is_new) ++revision_;
}

}  // namespace crossnav::planner
