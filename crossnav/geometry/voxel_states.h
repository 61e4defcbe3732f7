// SPDX-License-Identifier: MIT
// The seven operational voxel states and their permitted uses: tab:supp_voxel_states and
// tab:supp_astar_penalties as one table. UNKNOWN is the absence of a state.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace crossnav::geometry {

/// Values reach disk (map files, replays): do not change them.
enum class VoxelState : std::uint8_t {
  kUnknown = 0,
  kOccupied = 1,
  kTraversable = 2,
  kTraversableStair = 3,
  kTraversableFake = 4,
  kStair = 5,
  kStairExpanded = 6,
  kFakeStair = 7,
};
inline constexpr int kVoxelStateCount = 8;

struct StateFacts {
  std::string_view name;
  bool is_surface;     ///< observed geometry; may carry a feature and support air
  bool is_pathable;    ///< a path may pass
  bool is_targetable;  ///< a path may end
  double penalty;      ///< added to the cost of entering [voxels]
};

inline constexpr std::array<StateFacts, kVoxelStateCount> kStateFacts = {{
    {"UNKNOWN", false, false, false, 0},
    {"OCCUPIED", true, false, false, 0},
    {"TRAVERSABLE", false, true, true, 0},
    {"TRAVERSABLE_STAIR", false, true, true, 0},
    {"TRAVERSABLE_FAKE", false, false, false, 0},
    {"STAIR", true, true, true, 4},
    {"STAIR_EXPANDED", true, true, true, 5},
    {"FAKE_STAIR", true, true, false, 10},
}};

constexpr const StateFacts& FactsOf(VoxelState state) {
  return kStateFacts[static_cast<std::size_t>(state)];
}
constexpr bool IsSurface(VoxelState state) {
  return FactsOf(state).is_surface;
}
constexpr bool IsPathable(VoxelState state) {
  return FactsOf(state).is_pathable;
}

}  // namespace crossnav::geometry
