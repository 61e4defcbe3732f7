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
constexpr std::uint16_t kHasCompact = 0x8000;          // bit of the number of rows

class RowWriter {
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
class RowReader {
 public:
  explicit RowReader(ByteView bytes) : bytes_(bytes) {}
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

// Writes all low bytes, then all high bytes: adjacent exponents compress well.
void PutHalves(const std::vector<std::uint16_t>& halves, Bytes& out) {
  const std::size_t n = halves.size(), begin = out.size();
  out.resize(begin + 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    out[begin + i] = static_cast<std::uint8_t>(halves[i] & 0xff);
    out[begin + n + i] = static_cast<std::uint8_t>(halves[i] >> 8);
  }
}

bool IsSoundRow(const PlacedRow& row) {
  const memory::MemoryRow& r = row.data;
  return std::isfinite(r.weight) && r.weight > 0 && std::isfinite(r.best_confidence) &&
         r.p_best_view_world.allFinite() && row.row >= 0 &&
         std::all_of(r.half.begin(), r.half.end(), IsFiniteHalf) &&
         std::count(r.compact.begin(), r.compact.end(), std::int8_t{-128}) == 0;
}

// The feature numbers that follow the facts: scales, halves, then compact rows.
struct FeatureParts {
  std::size_t rows = 0, halves = 0, compact = 0;  // numbers of the latter two
  bool has_compact = false;

  std::size_t Bytes() const { return (has_compact ? 4 * rows : 0) + 2 * halves + compact; }
};

// Reads a scale for each row, 0 for half-precision rows. False if a scale is invalid.
bool ReadScales(std::size_t dim, RowReader r, std::vector<PlacedRow>& rows, FeatureParts& parts) {
  for (PlacedRow& row : rows) {
    const float scale = parts.has_compact ? r.Get<float>() : 0.0f;
    if (!std::isfinite(scale) || scale < 0) return false;
    row.data.scale = scale;
    (scale > 0 ? parts.compact : parts.halves) += dim;
  }
  return r.ok();
}

void ReadNumbers(std::size_t dim, ByteView raw, const FeatureParts& parts,
                 std::vector<PlacedRow>& rows) {
  const ByteView numbers = raw.last(2 * parts.halves + parts.compact);
  const ByteView low = numbers.first(parts.halves), high = numbers.subspan(parts.halves);
  std::size_t half = 0, compact = 2 * parts.halves;
  for (PlacedRow& row : rows) {
    if (row.data.scale > 0) {
      row.data.compact.resize(dim);
      std::memcpy(row.data.compact.data(), &numbers[compact], dim);
      compact += dim;
      continue;
    }
    row.data.half.resize(dim);
    for (std::uint16_t& value : row.data.half) {
      value = static_cast<std::uint16_t>(low[half] | high[half] << 8);
      ++half;
    }
  }
}

}  // namespace

Bytes EncodeMapBlock(const geometry::MapBlock& block, geometry::VoxelMap::Cursor& states) {
  RowWriter w;
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
  RowReader r(raw);
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
  RowWriter w;
  std::vector<std::uint16_t> halves;
  std::vector<std::int8_t> compact;
  std::vector<float> scales;
  halves.reserve(rows.size() * memory.Dim());
  w.Put(std::uint16_t{0});  // placeholder for the number of rows
  for (std::int64_t row : rows) {
    const memory::MemoryRow data = memory.RowAt(row);
    w.Put(static_cast<std::uint16_t>(geometry::CellIndexOf(data.key)));
    w.Put(static_cast<std::uint32_t>(row));
    w.Put(data.weight);
    w.Put(data.best_confidence);
    for (int axis = 0; axis < 3; ++axis) w.Put(data.p_best_view_world[axis]);
    halves.insert(halves.end(), data.half.begin(), data.half.end());
    compact.insert(compact.end(), data.compact.begin(), data.compact.end());
    scales.push_back(data.compact.empty() ? 0.0f : data.scale);
  }
  const auto count = static_cast<std::uint16_t>(rows.size() | (compact.empty() ? 0 : kHasCompact));
  std::memcpy(w.bytes().data(), &count, sizeof(count));
  if (!compact.empty())
    for (float scale : scales) w.Put(scale);
  PutHalves(halves, w.bytes());
  for (std::int8_t value : compact) w.Put(value);
  return std::move(w.bytes());
}

std::optional<std::vector<PlacedRow>> DecodeFeatureBlock(const VoxelKey& key, int dim,
                                                         ByteView raw) {
  RowReader r(raw);
  const auto flagged = r.Get<std::uint16_t>();
  FeatureParts parts;
  parts.rows = flagged & ~kHasCompact;
  parts.has_compact = (flagged & kHasCompact) != 0;
  if (parts.rows == 0 || parts.rows > kBlockVoxels || r.left() < parts.rows * kRowFacts)
    return std::nullopt;
  std::bitset<kBlockVoxels> seen;
  std::vector<PlacedRow> rows(parts.rows);
  for (PlacedRow& row : rows) {
    const auto cell = r.Get<std::uint16_t>();
    if (cell >= kBlockVoxels || seen[cell]) return std::nullopt;
    seen.set(cell);
    row.data.key = geometry::KeyInBlock(key, cell);
    row.row = r.Get<std::uint32_t>();
    row.data.weight = r.Get<float>();
    row.data.best_confidence = r.Get<float>();
    for (int axis = 0; axis < 3; ++axis) row.data.p_best_view_world[axis] = r.Get<float>();
  }
  const auto numbers = static_cast<std::size_t>(dim);
  if (!ReadScales(numbers, r, rows, parts) || r.left() != parts.Bytes()) return std::nullopt;
  ReadNumbers(numbers, raw, parts, rows);
  if (!std::all_of(rows.begin(), rows.end(), IsSoundRow)) return std::nullopt;
  return rows;
}

std::size_t MaxFeatureBlockBytes(int dim) {
  return 2 + kBlockVoxels * (kRowFacts + 4 + 2 * static_cast<std::size_t>(dim));
}

}  // namespace crossnav::store
