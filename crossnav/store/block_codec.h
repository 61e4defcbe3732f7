// SPDX-License-Identifier: MIT
// Codec of a block's content (docs/formats/map_file.md). Little-endian. Decoding checks every
// length and value, because files come from outside.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/geometry/map_blocks.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/store/sealed_blob.h"

namespace crossnav::store {

/// Evidence, stair marks and derived states of 512 voxels.
Bytes EncodeMapBlock(const geometry::MapBlock& block, geometry::VoxelMap::Cursor& states);
/// Decodes the evidence; states are derived again. Empty if the bytes are no map block.
std::optional<geometry::MapBlock> DecodeMapBlock(const geometry::VoxelKey& key, ByteView raw);

/// One feature row with its place in the memory's order.
struct PlacedRow {
  std::int64_t row = 0;
  memory::MemoryRow data;
};

/// The rows of one block, ascending; `rows` are row numbers of `memory`.
Bytes EncodeFeatureBlock(const memory::SemanticMemory& memory,
                         const std::vector<std::int64_t>& rows);
/// Empty if the bytes are not rows of `dim` finite numbers, one per voxel.
std::optional<std::vector<PlacedRow>> DecodeFeatureBlock(const geometry::VoxelKey& key, int dim,
                                                         ByteView raw);

/// Upper bounds of a block of either kind.
constexpr std::size_t kMaxMapBlockBytes = 5 * 64 + 512 + 1 + 512 * 4;
std::size_t MaxFeatureBlockBytes(int dim);

}  // namespace crossnav::store
