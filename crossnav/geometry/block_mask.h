// SPDX-License-Identifier: MIT
// One bit per voxel of an 8x8x8 block: eight 64-bit words, one per z slice; inside a slice x is
// fastest. Bit i is cell i of sparse_grid.h.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "crossnav/geometry/sparse_grid.h"

namespace crossnav::geometry {

struct BlockMask {
  std::array<std::uint64_t, kBlockSide> slices{};

  bool Test(int cell) const { return (slices[cell >> 6] >> (cell & 63)) & 1; }
  void Set(int cell) { slices[cell >> 6] |= std::uint64_t{1} << (cell & 63); }
  void Reset(int cell) { slices[cell >> 6] &= ~(std::uint64_t{1} << (cell & 63)); }

  bool Any() const {
    std::uint64_t any = 0;
    for (const std::uint64_t slice : slices) any |= slice;
    return any != 0;
  }
  int Count() const {
    int count = 0;
    for (const std::uint64_t slice : slices) count += std::popcount(slice);
    return count;
  }

  BlockMask& operator|=(const BlockMask& other) {
    for (int z = 0; z < kBlockSide; ++z) slices[z] |= other.slices[z];
    return *this;
  }
  BlockMask& operator&=(const BlockMask& other) {
    for (int z = 0; z < kBlockSide; ++z) slices[z] &= other.slices[z];
    return *this;
  }
  friend BlockMask operator|(BlockMask a, const BlockMask& b) { return a |= b; }
  friend BlockMask operator&(BlockMask a, const BlockMask& b) { return a &= b; }
  friend BlockMask operator~(const BlockMask& a) {
    BlockMask out;
    for (int z = 0; z < kBlockSide; ++z) out.slices[z] = ~a.slices[z];
    return out;
  }
  friend bool operator==(const BlockMask&, const BlockMask&) = default;
};

/// Calls visit(cell) for every set bit, in cell order.
template <class F>
void ForEachCell(const BlockMask& mask, F&& visit) {
  for (int z = 0; z < kBlockSide; ++z)
    for (std::uint64_t bits = mask.slices[z]; bits != 0; bits &= bits - 1)
      visit((z << 6) | std::countr_zero(bits));
}

}  // namespace crossnav::geometry
