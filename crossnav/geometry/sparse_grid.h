// SPDX-License-Identifier: MIT
// Sparse container: a hash of 8x8x8-voxel blocks; the block is the user's struct. Blocks never
// move. Iteration follows the order of creation, so that equal inputs give equal orders.
// Unbounded indices of any sign. Readers may share it while nobody writes; a Cursor belongs to
// one thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

inline constexpr int kBlockBits = 3;
inline constexpr int kBlockSide = 1 << kBlockBits;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// Block that holds `key`, in block units (arithmetic shift: floor for negative indices too).
inline VoxelKey BlockKeyOf(const VoxelKey& key) {
  return {key.x >> kBlockBits, key.y >> kBlockBits, key.z >> kBlockBits};
}

/// Position inside its block: x fastest, z slowest, in [0, 512).
inline int CellIndexOf(const VoxelKey& key) {
  constexpr int kMask = kBlockSide - 1;
  return (key.x & kMask) | (key.y & kMask) << kBlockBits | (key.z & kMask) << (2 * kBlockBits);
}

inline VoxelKey KeyInBlock(const VoxelKey& block, int cell) {
  constexpr int kMask = kBlockSide - 1;
  return {block.x * kBlockSide + (cell & kMask),
          block.y * kBlockSide + ((cell >> kBlockBits) & kMask),
          block.z * kBlockSide + (cell >> (2 * kBlockBits))};
}

template <class Block>
class SparseGrid {
 public:
  struct Entry {
    VoxelKey key;  ///< in block units
    Block block;
  };

  SparseGrid() : slots_(64) {}

  /// The block at `block_key`, or null. Cost O(1).
  const Block* Find(const VoxelKey& block_key) const {
    const std::int32_t index = slots_[SlotOf(block_key)].index;
    return index == kEmpty ? nullptr : &entries_[index].block;
  }
  Block* Find(const VoxelKey& block_key) {
    return const_cast<Block*>(static_cast<const SparseGrid*>(this)->Find(block_key));
  }

  /// The same with its key.
  Entry* FindEntry(const VoxelKey& block_key) {
    const std::int32_t index = slots_[SlotOf(block_key)].index;
    return index == kEmpty ? nullptr : &entries_[index];
  }

  /// The block at `block_key`, made with `Block()` if absent.
  Block& Touch(const VoxelKey& block_key) { return TouchEntry(block_key).block; }

  /// The same with its key; its address stays valid as long as the grid lives.
  Entry& TouchEntry(const VoxelKey& block_key) {
    std::size_t slot = SlotOf(block_key);
    if (slots_[slot].index == kEmpty) {
      if (2 * (entries_.size() + 1) > slots_.size()) {
        Rehash(2 * slots_.size());
        slot = SlotOf(block_key);
      }
      slots_[slot] = {block_key, static_cast<std::int32_t>(entries_.size())};
      entries_.push_back(Entry{block_key, Block()});
    }
    return entries_[slots_[slot].index];
  }

  std::size_t size() const { return entries_.size(); }
  const std::deque<Entry>& entries() const { return entries_; }
  std::deque<Entry>& entries() { return entries_; }

  /// Bytes held, without allocations inside blocks.
  std::size_t Bytes() const {
    return slots_.size() * sizeof(Slot) + entries_.size() * sizeof(Entry);
  }

 private:
  static constexpr std::int32_t kEmpty = -1;

  struct Slot {  // with its key, so that a search touches no block
    VoxelKey key;
    std::int32_t index = kEmpty;
  };

  std::size_t SlotOf(const VoxelKey& block_key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = VoxelKeyHash()(block_key) & mask;
    while (slots_[slot].index != kEmpty && slots_[slot].key != block_key) slot = (slot + 1) & mask;
    return slot;
  }

  void Rehash(std::size_t slot_count) {
    slots_.assign(slot_count, Slot());
    for (std::size_t i = 0; i < entries_.size(); ++i)
      slots_[SlotOf(entries_[i].key)] = {entries_[i].key, static_cast<std::int32_t>(i)};
  }

  std::vector<Slot> slots_;  // open addressing, power of two
  std::deque<Entry> entries_;
};

/// Remembers where some hundred blocks are: the pixels of a noisy image go to and fro between a
/// few.
template <class Block>
class KnownBlocks {
 public:
  /// The block that holds `key`: find(its key) where it is not known.
  template <class F>
  Block& Of(const VoxelKey& key, F&& find) {
    // All axes compared at once: a branch per axis would be unpredictable.
    const std::int32_t x = key.x >> kBlockBits, y = key.y >> kBlockBits, z = key.z >> kBlockBits;
    Known& known = known_[static_cast<std::uint32_t>(x + 7 * y + 31 * z) % kKnown];
    const bool is_other = ((known.key.x ^ x) | (known.key.y ^ y) | (known.key.z ^ z)) != 0;
    if (is_other || known.block == nullptr) known = {{x, y, z}, &find(VoxelKey{x, y, z})};
    return *known.block;
  }

 private:
  struct Known {
    VoxelKey key;
    Block* block = nullptr;
  };
  static constexpr std::size_t kKnown = 256;  // chosen: in the first cache
  std::array<Known, kKnown> known_{};
};

/// Reads and writes with the last block remembered: neighbours mostly share a block.
template <class Grid, class Block>
class BlockCursor {
 public:
  explicit BlockCursor(Grid& grid) : grid_(&grid) {}

  /// The block that holds `key`, or null.
  Block* Find(const VoxelKey& key) {
    const VoxelKey block_key = BlockKeyOf(key);
    if (!is_set_ || block_key != block_key_) {
      block_ = grid_->Find(block_key);
      block_key_ = block_key;
      is_set_ = true;
    }
    return block_;
  }

  /// The block that holds `key`, made if absent.
  Block& Touch(const VoxelKey& key) {
    if (Block* block = Find(key)) return *block;
    block_ = &grid_->Touch(block_key_);
    return *block_;
  }

 private:
  Grid* grid_;
  Block* block_ = nullptr;
  VoxelKey block_key_;
  bool is_set_ = false;
};

template <class Block>
using GridCursor = BlockCursor<SparseGrid<Block>, Block>;
template <class Block>
using GridReader = BlockCursor<const SparseGrid<Block>, const Block>;

}  // namespace crossnav::geometry
