// SPDX-License-Identifier: MIT
// A map's evidence as plain sets, to compare with the reference.
#pragma once

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {

inline KeySet KeysOf(const VoxelMap& map, BlockMask MapBlock::*mask) {
  KeySet keys;
  for (const MapBlock& block : ExportBlocks(map))
    ForEachCell(block.*mask, [&](int cell) { keys.insert(KeyInBlock(block.key, cell)); });
  return keys;
}

/// How many of `a` are not in `b`.
inline int CountMissing(const KeySet& a, const KeySet& b) {
  int count = 0;
  for (const VoxelKey& key : a) count += b.count(key) == 0;
  return count;
}

/// "" if the map's evidence is exactly the reference's.
inline std::string CompareEvidence(const VoxelMap& map, const ReferenceEvidence& reference) {
  const KeySet hit = KeysOf(map, &MapBlock::hit), free = KeysOf(map, &MapBlock::free);
  const int counts[] = {CountMissing(reference.hit, hit), CountMissing(hit, reference.hit),
                        CountMissing(reference.free, free), CountMissing(free, reference.free)};
  if (counts[0] + counts[1] + counts[2] + counts[3] == 0) return "";
  return "hit: " + std::to_string(counts[0]) + " missing, " + std::to_string(counts[1]) +
         " extra; free: " + std::to_string(counts[2]) + " missing, " + std::to_string(counts[3]) +
         " extra";
}

}  // namespace crossnav::geometry::testing
