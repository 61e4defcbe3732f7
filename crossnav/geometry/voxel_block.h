// SPDX-License-Identifier: MIT
// One block of the map, 8x8x8 voxels: evidence masks, derived states, and masks of the current
// frame. Internal to the map; readers go through VoxelMap and its Cursor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "crossnav/geometry/block_mask.h"
#include "crossnav/geometry/voxel_states.h"

namespace crossnav::geometry {

/// State and evidence of one voxel.
struct Voxel {
  VoxelState state = VoxelState::kUnknown;
  bool is_inflated = false;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// Recent hits and passes of one voxel (map.clearing = evidence).
struct HitCount {
  std::uint16_t hits = 0;
  std::uint16_t passes = 0;
  friend bool operator==(const HitCount&, const HitCount&) = default;
};
using HitCounts = std::array<HitCount, kBlockVoxels>;

struct VoxelBlock {
  // Evidence.
  BlockMask hit;            ///< a surface by depth returns (under `evidence`: by the counts)
  BlockMask free;           ///< ray-observed or body free, and not hit
  BlockMask agent_support;  ///< the agent stood on it, no return confirmed it
  BlockMask stair_low;      ///< bits 0 and 1 of the StairMark
  BlockMask stair_high;
  std::unique_ptr<HitCounts> counts;  ///< null where clearing = never
  BlockMask settled;  ///< by its counts free for sure: another pass changes nothing of them

  // Derived: bits 0-2 VoxelState, bit 3 inflated.
  std::array<std::uint8_t, kBlockVoxels> cells{};

  // Since the last UpdateStates().
  BlockMask changed_surface;  ///< surface or its stair mark
  BlockMask changed_free;
  bool is_listed = false;  ///< in the map's list of changed blocks
  bool is_stale = false;   ///< states wait to be derived again

  // The frame being integrated; empty in between.
  BlockMask frame_hit;
  BlockMask frame_free;
  bool is_in_frame = false;

  BlockMask Surface() const { return hit | agent_support; }
};

inline constexpr std::uint8_t kInflatedBit = 8;

inline Voxel DecodeCell(std::uint8_t cell) {
  return {static_cast<VoxelState>(cell & 7), (cell & kInflatedBit) != 0};
}

}  // namespace crossnav::geometry
