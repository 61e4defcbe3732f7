// SPDX-License-Identifier: MIT
// Sealed blobs: zstd-compressed bytes with an XXH3 checksum that also covers their place, so that a
// misplaced block counts as damage.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::store {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// XXH3, 64 bits, as the signed integer that SQLite stores.
std::int64_t HashBytes(ByteView bytes);

/// Place of a block in the file.
struct BlockPlace {
  std::string_view table;
  std::int64_t id = 0;
  geometry::VoxelKey key;  ///< in block units
  std::int64_t raw_hash = 0;
};

/// Checksum of a compressed block at its place.
std::int64_t HashBlock(const BlockPlace& place, ByteView compressed);

Bytes Compress(ByteView raw);
/// Empty if the bytes are no zstd frame or exceed `max_bytes` decompressed.
std::optional<Bytes> Decompress(ByteView compressed, std::size_t max_bytes);

}  // namespace crossnav::store
