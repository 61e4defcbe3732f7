// SPDX-License-Identifier: MIT
#include "crossnav/geometry/frame.h"

#include <algorithm>

namespace crossnav::geometry {
namespace {

int MaxCount(const MapConfig& config) {
  return std::max(config.max_hits, config.min_hits);
}

/// map.clearing = never: once hit, always hit.
void MergeForever(VoxelBlock& block) {
  const BlockMask surface = block.Surface();
  const BlockMask new_hit = block.frame_hit & ~block.hit;
  block.hit |= new_hit;
  block.changed_surface |= new_hit & ~surface;
  const BlockMask seen_through = block.frame_free & ~block.hit;
  block.changed_surface |= seen_through & block.agent_support;
  block.agent_support &= ~(block.hit | seen_through);
  block.changed_free |= seen_through & ~block.free;
  block.free |= seen_through;
  block.free &= ~block.hit;
}

/// map.clearing = evidence: both counts cover the recent past. A hit cancels a pass and the
/// reverse, so that a change is accepted after a few frames, whatever the history.
void MergeCounted(VoxelBlock& block, const MapConfig& config) {
  if (!block.counts) block.counts = std::make_unique<HitCounts>();
  const int max_count = MaxCount(config);
  const auto is_occupied = [&](const HitCount& count) {
    return count.hits >= std::max<double>(config.min_hits, config.hit_ratio * count.passes);
  };
  const BlockMask surface = block.Surface();
  ForEachCell(block.frame_hit, [&](int cell) {
    HitCount& count = (*block.counts)[cell];
    if (count.hits < max_count) ++count.hits;
    if (count.passes > 0) --count.passes;
    if (is_occupied(count)) block.hit.Set(cell);
  });
  block.settled &= ~block.frame_hit;
  const BlockMask passed = block.frame_free & ~block.frame_hit;
  ForEachCell(passed & ~block.settled, [&](int cell) {
    HitCount& count = (*block.counts)[cell];
    if (count.passes < max_count) ++count.passes;
    if (count.hits > 0) --count.hits;
    if (!is_occupied(count)) block.hit.Reset(cell);
    if (IsSettled(count, config)) block.settled.Set(cell);
  });
  block.changed_free |= passed & ~block.free;
  block.free |= passed;
  block.agent_support &= ~(passed | block.hit);
  const BlockMask now = block.Surface();
  block.changed_surface |= (surface & ~now) | (now & ~surface);
}

}  // namespace

bool IsSettled(const HitCount& count, const MapConfig& config) {
  return count.hits == 0 && count.passes >= MaxCount(config);
}

void ListInFrame(MapData& map, GridEntry& entry) {
  if (entry.block.is_in_frame) return;
  entry.block.is_in_frame = true;
  map.frame.push_back(&entry);
}

void MergeFrame(MapData& map) {
  const bool is_counted = map.config.clearing == "evidence";
  for (GridEntry* entry : map.frame) {
    VoxelBlock& block = entry->block;
    if (is_counted)
      MergeCounted(block, map.config);
    else
      MergeForever(block);
    if ((block.changed_surface | block.changed_free).Any()) ListChanged(map, *entry);
    block.frame_hit = block.frame_free = BlockMask();
    block.is_in_frame = false;
  }
  map.frame.clear();
}

}  // namespace crossnav::geometry
