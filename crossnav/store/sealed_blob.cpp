// SPDX-License-Identifier: MIT
#include "crossnav/store/sealed_blob.h"

#include <xxhash.h>
#include <zstd.h>

#include <array>
#include <bit>
#include <cstring>
#include <memory>

#include "crossnav/core/check.h"

namespace crossnav::store {
namespace {

constexpr int kLevel = 1;  // chosen: half-precision features barely shrink further at level 3

struct FreeContext {
  void operator()(ZSTD_CCtx* c) const { ZSTD_freeCCtx(c); }
  void operator()(ZSTD_DCtx* c) const { ZSTD_freeDCtx(c); }
};

}  // namespace

std::int64_t HashBytes(ByteView bytes) {
  return std::bit_cast<std::int64_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

std::int64_t HashBlock(const BlockPlace& place, ByteView compressed) {
  std::array<std::int64_t, 5> where = {place.id, place.key.x, place.key.y, place.key.z,
                                       place.raw_hash};
  const std::uint64_t seed = XXH3_64bits_withSeed(
      where.data(), sizeof(where), XXH3_64bits(place.table.data(), place.table.size()));
  return std::bit_cast<std::int64_t>(
      XXH3_64bits_withSeed(compressed.data(), compressed.size(), seed));
}

Bytes Compress(ByteView raw) {
  static thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  Bytes out(ZSTD_compressBound(raw.size()));
  const std::size_t size =
      ZSTD_compressCCtx(context.get(), out.data(), out.size(), raw.data(), raw.size(), kLevel);
  CROSSNAV_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

std::optional<Bytes> Decompress(ByteView compressed, std::size_t max_bytes) {
  static thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  const unsigned long long size = ZSTD_getFrameContentSize(compressed.data(), compressed.size());
  // ZSTD's two error values exceed any limit.
  if (size > max_bytes) return std::nullopt;
  Bytes out(static_cast<std::size_t>(size));
  const std::size_t got = ZSTD_decompressDCtx(context.get(), out.data(), out.size(),
                                              compressed.data(), compressed.size());
  if (ZSTD_isError(got) != 0 || got != out.size()) return std::nullopt;
  return out;
}

}  // namespace crossnav::store
