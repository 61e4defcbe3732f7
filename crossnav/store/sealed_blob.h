// SPDX-License-Identifier: MIT
// Bytes as they lie in the file: zstd-compressed, with an XXH3 checksum that also covers where they
// belong, so that a block in the wrong place is damage too.
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

/// XXH3, 64 bits, as the signed number SQLite stores.
std::int64_t HashBytes(ByteView bytes);

/// Where a block belongs.
struct BlockPlace {
  std::string_view table;
  std::int64_t id = 0;
  geometry::VoxelKey key;  ///< in block units
  std::int64_t raw_hash = 0;
};

/// Checksum of a compressed block at its place.
std::int64_t HashBlock(const BlockPlace& place, ByteView compressed);

Bytes Compress(ByteView raw);
/// Empty if the bytes are no zstd frame or would grow above `max_bytes`.
std::optional<Bytes> Decompress(ByteView compressed, std::size_t max_bytes);

}  // namespace crossnav::store
