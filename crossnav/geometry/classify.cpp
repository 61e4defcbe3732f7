// SPDX-License-Identifier: MIT
#include "crossnav/geometry/classify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace crossnav::geometry {
namespace {

using Slice = std::uint64_t;  // 8 x 8 voxels of one z, x fastest

static_assert(std::endian::native == std::endian::little, "rows of cells are written as words");

int FloorDiv8(int a) {
  return a >> kBlockBits;
}

/// The surfaces of a stack of blocks, slice by slice, from z = z_low upwards.
struct Column {
  std::vector<Slice> surface;
  std::vector<Slice> unconfirmed;  ///< without STAIR and STAIR_EXPANDED
};

void ReadColumn(const MapData& map, const VoxelKey& block_key, int z_low, int count, Column* out) {
  out->surface.assign(count, 0);
  out->unconfirmed.assign(count, 0);
  const VoxelBlock* block = nullptr;
  for (int i = 0; i < count; ++i) {
    const int z = z_low + i, in_block = z & (kBlockSide - 1);
    if (i == 0 || in_block == 0)
      block = map.grid.Find(VoxelKey{block_key.x, block_key.y, FloorDiv8(z)});
    if (block == nullptr) continue;
    const Slice surface = block->hit.slices[in_block] | block->agent_support.slices[in_block];
    const Slice confirmed = block->stair_low.slices[in_block] ^ block->stair_high.slices[in_block];
    out->surface[i] = surface;
    out->unconfirmed[i] = surface & ~confirmed;
  }
}

/// Obstacles for each support slice of the block (from support_depth below it).
struct Obstacles {
  std::vector<Slice> any;          ///< by any surface
  std::vector<Slice> unconfirmed;  ///< by surfaces that are not confirmed stairs
};

/// Rows and columns of bits that stay when a slice is read `d` in [0, 8) further along x.
Slice ColumnsFrom(int d) {
  return 0x0101010101010101ULL * ((0xffU << d) & 0xffU);
}

/// Slice shifted by (dx, dy): its bit (x, y) is bit (x + dx, y + dy) of two slices that are
/// neighbours in x, for one row of blocks.
Slice ReadShiftedX(Slice here, Slice next, int dx) {
  if (dx == 0) return here;
  return (here & ColumnsFrom(dx)) >> dx | (next & ~ColumnsFrom(dx)) << (kBlockSide - dx);
}
Slice ReadShiftedY(Slice here, Slice next, int dy) {
  if (dy == 0) return here;
  return here >> (kBlockSide * dy) | next << (kBlockSide * (kBlockSide - dy));
}

class ObstacleWindow {
 public:
  ObstacleWindow(const MapData& map, const VoxelKey& block)
      : map_(map), block_(block), reach_((static_cast<int>(map.cells.inflation) + 7) / 8) {
    side_ = 2 * reach_ + 1;
    supports_ = map.cells.support_depth + kBlockSide;
    windows_.assign(2 * side_ * side_ * supports_, 0);
    for (int y = -reach_; y <= reach_; ++y)
      for (int x = -reach_; x <= reach_; ++x) ReadWindows(x, y);
  }

  Obstacles Dilated() const {
    Obstacles out;
    out.any.assign(supports_, 0);
    out.unconfirmed.assign(supports_, 0);
    if (!has_any_) return out;
    const double radius = map_.cells.inflation;
    const int r = static_cast<int>(radius);
    for (int dy = -r; dy <= r; ++dy) {
      for (int dx = -r; dx <= r; ++dx) {
        if (dx * dx + dy * dy > radius * radius) continue;
        for (int s = 0; s < supports_; ++s) {
          out.any[s] |= Shifted(0, s, dx, dy);
          out.unconfirmed[s] |= Shifted(1, s, dx, dy);
        }
      }
    }
    return out;
  }

 private:
  Slice& At(int kind, int x, int y, int s) {
    return windows_[((kind * side_ + y + reach_) * side_ + x + reach_) * supports_ + s];
  }
  Slice Get(int kind, int x, int y, int s) const {
    if (x < -reach_ || x > reach_ || y < -reach_ || y > reach_) return 0;
    return windows_[((kind * side_ + y + reach_) * side_ + x + reach_) * supports_ + s];
  }

  /// Surfaces more than max_climb and at most agent_height above each support slice.
  void ReadWindows(int x, int y) {
    const int first = map_.cells.max_climb + 1, last = map_.cells.agent_height;
    if (last < first) return;
    const int z_low = block_.z * kBlockSide - map_.cells.support_depth + first;
    const int count = supports_ + last - first;
    ReadColumn(map_, {block_.x + x, block_.y + y, block_.z}, z_low, count, &column_);
    Slice any = 0;
    for (const Slice surface : column_.surface) any |= surface;
    if (any == 0) return;
    has_any_ = true;
    for (int s = 0; s < supports_; ++s) {
      for (int i = s; i <= s + last - first; ++i) {
        At(0, x, y, s) |= column_.surface[i];
        At(1, x, y, s) |= column_.unconfirmed[i];
      }
    }
  }

  Slice Shifted(int kind, int s, int dx, int dy) const {
    const int bx = FloorDiv8(dx), by = FloorDiv8(dy);
    const int rx = dx & (kBlockSide - 1), ry = dy & (kBlockSide - 1);
    const Slice here = ReadShiftedX(Get(kind, bx, by, s), Get(kind, bx + 1, by, s), rx);
    if (ry == 0) return here;
    const Slice next = ReadShiftedX(Get(kind, bx, by + 1, s), Get(kind, bx + 1, by + 1, s), rx);
    return ReadShiftedY(here, next, ry);
  }

  const MapData& map_;
  VoxelKey block_;
  int reach_, side_ = 0, supports_ = 0;
  bool has_any_ = false;
  std::vector<Slice> windows_;
  Column column_;
};

/// The derived state as bit planes: bits 0-2 VoxelState, bit 3 inflated.
struct StatePlanes {
  std::array<Slice, 4> bits{};
};

struct SliceEvidence {
  Slice surface = 0, free = 0, stair_low = 0, stair_high = 0;
};

StatePlanes SurfacePlanes(const SliceEvidence& e) {
  StatePlanes out;
  out.bits[0] = e.surface & ~(e.stair_high & ~e.stair_low);
  out.bits[1] = e.surface & e.stair_high;
  out.bits[2] = e.surface & (e.stair_low | e.stair_high);
  return out;
}

/// `s` is the slice's index in `own` and in `obstacles`, support_depth above the lowest.
StatePlanes ClassifySlice(const SliceEvidence& e, int s, int support_depth, const Column& own,
                          const Obstacles& obstacles) {
  StatePlanes out = SurfacePlanes(e);
  const Slice confirmed = e.surface & (e.stair_low ^ e.stair_high);
  const Slice fake = e.surface & e.stair_low & e.stair_high;
  out.bits[3] = (confirmed & obstacles.unconfirmed[s]) | (fake & obstacles.any[s]);
  // First support below, nearest first: eq:supp_support_classification.
  Slice open = e.free & ~e.surface;
  for (int k = 1; k <= support_depth && open != 0; ++k) {
    const Slice found = open & own.surface[s - k];
    const Slice on_stair = found & ~own.unconfirmed[s - k];
    out.bits[0] |= on_stair;
    out.bits[1] |= found;
    out.bits[3] |=
        (found & ~on_stair & obstacles.any[s - k]) | (on_stair & obstacles.unconfirmed[s - k]);
    open &= ~found;
  }
  out.bits[2] |= open;  // TRAVERSABLE_FAKE
  return out;
}

/// Byte i is 1 where bit i of `row` is set.
std::uint64_t SpreadToBytes(std::uint64_t row) {
  const std::uint64_t spread = (row & 0xff) * 0x0101010101010101ULL & 0x8040201008040201ULL;
  return ((spread + 0x7f7f7f7f7f7f7f7fULL) >> 7) & 0x0101010101010101ULL;
}

void WriteSlice(const StatePlanes& planes, int z, GridEntry& entry,
                std::vector<StateChange>* changes) {
  for (int y = 0; y < kBlockSide; ++y) {
    std::uint64_t row = 0;
    for (int b = 0; b < 4; ++b) row |= SpreadToBytes(planes.bits[b] >> (kBlockSide * y)) << b;
    std::uint8_t* cells = &entry.block.cells[z * 64 + y * kBlockSide];
    std::uint64_t old = 0;
    std::memcpy(&old, cells, sizeof old);
    if (old == row) continue;
    std::memcpy(cells, &row, sizeof row);
    for (std::uint64_t diff = old ^ row; diff != 0;) {
      const int x = std::countr_zero(diff) / 8;
      diff &= ~(std::uint64_t{0xff} << (8 * x));
      changes->push_back({KeyInBlock(entry.key, z * 64 + y * kBlockSide + x),
                          DecodeCell(static_cast<std::uint8_t>(row >> (8 * x)))});
    }
  }
}

/// Keys with states that depend on the block's changed surfaces.
struct KeyBox {
  VoxelKey lo, hi;
};

KeyBox DependentKeys(const GridEntry& entry, const MapCells& cells) {
  Slice flat = 0;
  int z_low = kBlockSide, z_high = -1;
  for (int z = 0; z < kBlockSide; ++z) {
    const Slice slice = entry.block.changed_surface.slices[z];
    if (slice == 0) continue;
    flat |= slice;
    z_low = std::min(z_low, z);
    z_high = z;
  }
  unsigned columns = 0;
  for (int y = 0; y < kBlockSide; ++y) columns |= (flat >> (kBlockSide * y)) & 0xff;
  const int r = static_cast<int>(cells.inflation);
  const VoxelKey base = KeyInBlock(entry.key, 0);
  return {{base.x + std::countr_zero(columns) - r, base.y + std::countr_zero(flat) / 8 - r,
           base.z + z_low - cells.agent_height},
          {base.x + static_cast<int>(std::bit_width(columns)) - 1 + r,
           base.y + (63 - std::countl_zero(flat)) / 8 + r, base.z + z_high + cells.support_depth}};
}

constexpr std::size_t kFewChanges = 256;  // chosen: below, a plain sort is as fast

/// Counting sort by `digit_count` binary digits of `value(key)`, up to ten at a time. Stable.
template <class F>
void SortByAxis(std::vector<StateChange>* changes, std::vector<StateChange>* other, int digit_count,
                const F& value) {
  constexpr int kDigits = 10;
  for (int shift = 0; shift < digit_count; shift += kDigits) {
    std::array<std::uint32_t, (1 << kDigits) + 1> start{};
    const auto digit = [&](const StateChange& change) {
      return (static_cast<std::uint32_t>(value(change.key)) >> shift) & ((1U << kDigits) - 1);
    };
    for (const StateChange& change : *changes) ++start[digit(change) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const StateChange& change : *changes) (*other)[start[digit(change)]++] = change;
    changes->swap(*other);
  }
}

}  // namespace

std::vector<GridEntry*> TakeStaleBlocks(MapData& map) {
  std::vector<GridEntry*> stale;
  const auto add = [&](GridEntry* entry) {
    if (entry == nullptr || entry->block.is_stale) return;
    entry->block.is_stale = true;
    stale.push_back(entry);
  };
  for (GridEntry* entry : map.changed) {
    add(entry);
    VoxelBlock& block = entry->block;
    if (block.changed_surface.Any()) {
      const KeyBox box = DependentKeys(*entry, map.cells);
      const VoxelKey lo = BlockKeyOf(box.lo), hi = BlockKeyOf(box.hi);
      for (int z = lo.z; z <= hi.z; ++z)
        for (int y = lo.y; y <= hi.y; ++y)
          for (int x = lo.x; x <= hi.x; ++x) add(map.grid.FindEntry({x, y, z}));
    }
    block.changed_surface = block.changed_free = BlockMask();
    block.is_listed = false;
  }
  map.changed.clear();
  return stale;
}

void ClassifyBlock(const MapData& map, GridEntry& entry, std::vector<StateChange>* changes) {
  VoxelBlock& block = entry.block;
  const int depth = map.cells.support_depth;
  Column own;
  ReadColumn(map, entry.key, entry.key.z * kBlockSide - depth, depth + kBlockSide, &own);
  const Obstacles obstacles = ObstacleWindow(map, entry.key).Dilated();
  for (int z = 0; z < kBlockSide; ++z) {
    const SliceEvidence evidence = {own.surface[depth + z], block.free.slices[z],
                                    block.stair_low.slices[z], block.stair_high.slices[z]};
    WriteSlice(ClassifySlice(evidence, depth + z, depth, own, obstacles), z, entry, changes);
  }
  block.is_stale = false;
}

void SortChanges(std::vector<StateChange>* changes) {
  if (changes->size() < kFewChanges) {
    std::sort(changes->begin(), changes->end(),
              [](const StateChange& a, const StateChange& b) { return a.key < b.key; });
    return;
  }
  VoxelKey lo = changes->front().key, hi = lo;
  for (const StateChange& change : *changes) {
    lo = {std::min(lo.x, change.key.x), std::min(lo.y, change.key.y), std::min(lo.z, change.key.z)};
    hi = {std::max(hi.x, change.key.x), std::max(hi.y, change.key.y), std::max(hi.z, change.key.z)};
  }
  const auto digits = [](std::int32_t first, std::int32_t last) {
    return static_cast<int>(std::bit_width(static_cast<std::uint32_t>(last - first)));
  };
  // The least important axis first; each pass keeps the order of equals.
  std::vector<StateChange> other(changes->size());
  SortByAxis(changes, &other, digits(lo.z, hi.z), [&](const VoxelKey& k) { return k.z - lo.z; });
  SortByAxis(changes, &other, digits(lo.y, hi.y), [&](const VoxelKey& k) { return k.y - lo.y; });
  SortByAxis(changes, &other, digits(lo.x, hi.x), [&](const VoxelKey& k) { return k.x - lo.x; });
}

}  // namespace crossnav::geometry
