// SPDX-License-Identifier: MIT
#include "crossnav/store/block_codec.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace crossnav::store {
namespace {

using geometry::BlockMask;
using geometry::kBlockVoxels;
using geometry::VoxelKey;

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::uint8_t kInflated = 8;                  // bit of a state byte
constexpr std::size_t kRowFacts = 2 + 4 + 4 + 4 + 12;  // cell, row, weight, confidence, view

class Writer {
 public:
  template <class T>
  void Put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), p, p + sizeof(T));
  }
  Bytes& bytes() { return bytes_; }

 private:
  Bytes bytes_;
};

// Reads past the end give zeros and make `ok` false.
class Reader {
 public:
  explicit Reader(ByteView bytes) : bytes_(bytes) {}
  template <class T>
  T Get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    if (left() < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  bool ok() const { return ok_; }

 private:
  ByteView bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

bool IsFiniteHalf(std::uint16_t bits) {
  return (bits & 0x7c00) != 0x7c00;
}

// Low bytes of all values, then high bytes: exponents lie side by side and compress.
void PutHalves(const std::vector<std::uint16_t>& halves, Bytes& out) {
  const std::size_t n = halves.size(), begin = out.size();
  out.resize(begin + 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    out[begin + i] = static_cast<std::uint8_t>(halves[i] & 0xff);
    out[begin + n + i] = static_cast<std::uint8_t>(halves[i] >> 8);
  }
}

bool IsSound(const PlacedRow& row) {
  const memory::MemoryRow& r = row.data;
  return std::isfinite(r.weight) && r.weight > 0 && std::isfinite(r.best_confidence) &&
         r.p_best_view_world.allFinite() && row.row >= 0 &&
         std::all_of(r.half.begin(), r.half.end(), IsFiniteHalf);
}

}  // namespace

Bytes EncodeMapBlock(const geometry::MapBlock& block, geometry::VoxelMap::Cursor& states) {
  Writer w;
  for (const BlockMask* mask :
       {&block.hit, &block.free, &block.agent_support, &block.stair_low, &block.stair_high})
    w.Put(mask->slices);
  for (int cell = 0; cell < kBlockVoxels; ++cell) {
    const geometry::Voxel voxel = states.At(geometry::KeyInBlock(block.key, cell));
    w.Put(static_cast<std::uint8_t>(static_cast<std::uint8_t>(voxel.state) |
                                    (voxel.is_inflated ? kInflated : 0)));
  }
  w.Put(static_cast<std::uint8_t>(block.counts.empty() ? 0 : 1));
  for (const geometry::HitCount& count : block.counts) {
    w.Put(count.hits);
    w.Put(count.passes);
  }
  return std::move(w.bytes());
}

std::optional<geometry::MapBlock> DecodeMapBlock(const VoxelKey& key, ByteView raw) {
  Reader r(raw);
  geometry::MapBlock block;
  block.key = key;
  for (BlockMask* mask :
       {&block.hit, &block.free, &block.agent_support, &block.stair_low, &block.stair_high})
    mask->slices = r.Get<std::array<std::uint64_t, geometry::kBlockSide>>();
  for (int cell = 0; cell < kBlockVoxels; ++cell) (void)r.Get<std::uint8_t>();
  const auto has_counts = r.Get<std::uint8_t>();
  if (has_counts > 1) return std::nullopt;
  block.counts.resize(has_counts != 0 ? kBlockVoxels : 0);
  for (geometry::HitCount& count : block.counts) {
    count.hits = r.Get<std::uint16_t>();
    count.passes = r.Get<std::uint16_t>();
  }
  if (!r.ok() || r.left() != 0) return std::nullopt;
  return block;
}

Bytes EncodeFeatureBlock(const memory::SemanticMemory& memory,
                         const std::vector<std::int64_t>& rows) {
  Writer w;
  w.Put(static_cast<std::uint16_t>(rows.size()));
  std::vector<std::uint16_t> halves;
  halves.reserve(rows.size() * memory.Dim());
  for (std::int64_t row : rows) {
    const memory::MemoryRow data = memory.RowAt(row);
    w.Put(static_cast<std::uint16_t>(geometry::CellIndexOf(data.key)));
    w.Put(static_cast<std::uint32_t>(row));
    w.Put(data.weight);
    w.Put(data.best_confidence);
    for (int axis = 0; axis < 3; ++axis) w.Put(data.p_best_view_world[axis]);
    halves.insert(halves.end(), data.half.begin(), data.half.end());
  }
  PutHalves(halves, w.bytes());
  return std::move(w.bytes());
}

std::optional<std::vector<PlacedRow>> DecodeFeatureBlock(const VoxelKey& key, int dim,
                                                         ByteView raw) {
  Reader r(raw);
  const std::size_t count = r.Get<std::uint16_t>();
  const std::size_t halves = count * static_cast<std::size_t>(dim);
  if (count == 0 || count > kBlockVoxels || r.left() != count * kRowFacts + 2 * halves)
    return std::nullopt;
  const ByteView low = raw.last(2 * halves).first(halves), high = raw.last(halves);
  std::bitset<kBlockVoxels> seen;
  std::vector<PlacedRow> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto cell = r.Get<std::uint16_t>();
    if (cell >= kBlockVoxels || seen[cell]) return std::nullopt;
    seen.set(cell);
    memory::MemoryRow& data = rows[i].data;
    data.key = geometry::KeyInBlock(key, cell);
    rows[i].row = r.Get<std::uint32_t>();
    data.weight = r.Get<float>();
    data.best_confidence = r.Get<float>();
    for (int axis = 0; axis < 3; ++axis) data.p_best_view_world[axis] = r.Get<float>();
    data.half.resize(dim);
    const std::size_t begin = i * static_cast<std::size_t>(dim);
    for (int k = 0; k < dim; ++k)
      data.half[k] = static_cast<std::uint16_t>(low[begin + k] | high[begin + k] << 8);
    if (!IsSound(rows[i])) return std::nullopt;
  }
  return rows;
}

std::size_t MaxFeatureBlockBytes(int dim) {
  return 2 + kBlockVoxels * (kRowFacts + 2 * static_cast<std::size_t>(dim));
}

}  // namespace crossnav::store
