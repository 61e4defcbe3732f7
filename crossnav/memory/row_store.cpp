// SPDX-License-Identifier: MIT
#include "crossnav/memory/row_store.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crossnav/core/check.h"

namespace crossnav::memory {
namespace {

double SquaredNorm(std::span<const float> v) {
  double sum = 0;
  for (float x : v) sum += static_cast<double>(x) * x;
  return sum;
}

template <class T>
void Permute(std::vector<T>& values, std::span<const std::int64_t> order) {
  std::vector<T> moved(order.size());
  for (std::size_t to = 0; to < order.size(); ++to) moved[to] = values[order[to]];
  values = std::move(moved);
}

// Unit text as integers, with less rounding than half precision.
struct WholeText {
  std::vector<std::int16_t> values;
  float scale = 0;  // text_i is about scale * values_i
};

WholeText ToWhole(std::span<const float> unit) {
  double largest = 0, sum = 0;
  for (float x : unit) {
    largest = std::max(largest, static_cast<double>(std::abs(x)));
    sum += std::abs(x);
  }
  WholeText out{std::vector<std::int16_t>(unit.size(), 0), 0};
  if (largest <= 0) return out;
  // Rounding adds at most half to each number.
  const double room = kMaxCompactText - static_cast<double>(unit.size());
  const double per_unit = std::min(32767 / largest, room / sum);
  CROSSNAV_CHECK(per_unit > 0, "fewer features than whole numbers can hold");
  for (std::size_t i = 0; i < unit.size(); ++i)
    out.values[i] = static_cast<std::int16_t>(std::lrint(unit[i] * per_unit));
  out.scale = static_cast<float>(1 / per_unit);
  return out;
}

}  // namespace

RowStore::RowStore(bool is_half, int dim)
    : is_half_(is_half), dim_(dim), full_(is_half ? 2 : 4, dim), compact_(1, dim) {}

void RowStore::SetDim(int dim) {
  full_.SetDim(dim);
  compact_.SetDim(dim);
  dim_ = dim;
}

std::int64_t RowStore::Bytes() const {
  const std::size_t places = places_.capacity() + full_rows_.capacity() + compact_rows_.capacity();
  return full_.Bytes() + compact_.Bytes() +
         static_cast<std::int64_t>(scales_.capacity() * sizeof(float) +
                                   places * sizeof(std::int32_t));
}

void RowStore::LeavePlain() {
  if (!IsPlain()) return;
  places_.resize(full_.size());
  std::iota(places_.begin(), places_.end(), 0);
  full_rows_ = places_;
}

std::int32_t RowStore::AppendFull(std::int32_t row) {
  full_rows_.push_back(row);
  return static_cast<std::int32_t>(full_.Append());
}

std::int32_t RowStore::AppendCompact(std::int32_t row, float scale) {
  compact_rows_.push_back(row);
  scales_.push_back(scale);
  return ~static_cast<std::int32_t>(compact_.Append());
}

void RowStore::Remove(std::int32_t place) {
  const bool is_compact = place < 0;
  RowPool& pool = is_compact ? compact_ : full_;
  std::vector<std::int32_t>& rows = is_compact ? compact_rows_ : full_rows_;
  const std::int32_t at = is_compact ? ~place : place;
  const std::int64_t last = pool.size() - 1;
  if (at != last) {
    pool.Copy(last, at);
    rows[at] = rows[last];
    places_[rows[at]] = place;
    if (is_compact) scales_[at] = scales_[last];
  }
  pool.Truncate(last);
  rows.pop_back();
  if (is_compact) scales_.pop_back();
}

std::int64_t RowStore::Append() {
  if (IsPlain()) return full_.Append();
  const auto row = static_cast<std::int32_t>(size());
  places_.push_back(AppendFull(row));
  return row;
}

void RowStore::Expand(std::int64_t row) {
  const std::vector<float> values = Read(row);
  const std::int32_t old = places_[row];
  places_[row] = AppendFull(static_cast<std::int32_t>(row));
  Remove(old);
  WriteFull(places_[row], values);
}

void RowStore::Compact(std::int64_t row) {
  if (IsCompact(row)) return;
  std::vector<std::int8_t> whole(dim_);
  const float scale = ToCompact(Read(row), whole.data());
  WriteCompact(row, whole, scale);
}

void RowStore::WriteCompact(std::int64_t row, std::span<const std::int8_t> values, float scale) {
  CROSSNAV_CHECK(static_cast<int>(values.size()) == dim_, "one value per feature");
  LeavePlain();
  if (!IsCompact(row)) {
    const std::int32_t old = places_[row];
    places_[row] = AppendCompact(static_cast<std::int32_t>(row), scale);
    Remove(old);
  }
  const std::int64_t at = CompactAt(row);
  std::copy(values.begin(), values.end(), compact_.At<std::int8_t>(at));
  scales_[at] = scale;
  std::int64_t squared = 0;
  for (std::int8_t x : values) squared += std::int64_t{x} * x;
  compact_.SetInverseNorm(at, static_cast<double>(squared));
}

float RowStore::ReadCompact(std::int64_t row, std::span<std::int8_t> out) const {
  CROSSNAV_CHECK(IsCompact(row) && static_cast<int>(out.size()) == dim_, "a compact row's values");
  std::copy_n(compact_.At<std::int8_t>(CompactAt(row)), dim_, out.data());
  return scales_[CompactAt(row)];
}

void RowStore::Fuse(std::int64_t row, float keep, const float* grid,
                    std::span<const CellShare> shares) {
  if (IsCompact(row)) Expand(row);
  const std::int64_t at = FullAt(row);
  const float squared = is_half_ ? FuseRow(full_.At<std::uint16_t>(at), dim_, keep, grid, shares)
                                 : FuseRow(full_.At<float>(at), dim_, keep, grid, shares);
  full_.SetInverseNorm(at, squared);
}

void RowStore::ReadFull(std::int64_t at, std::span<float> out) const {
  if (is_half_)
    FromHalf({full_.At<std::uint16_t>(at), out.size()}, out.data());
  else
    std::copy_n(full_.At<float>(at), dim_, out.data());
}

void RowStore::WriteFull(std::int64_t at, std::span<const float> values) {
  if (is_half_) {
    auto* halves = full_.At<std::uint16_t>(at);
    ToHalf(values, halves);
    std::vector<float> stored(values.size());
    FromHalf({halves, values.size()}, stored.data());
    full_.SetInverseNorm(at, SquaredNorm(stored));
    return;
  }
  std::copy(values.begin(), values.end(), full_.At<float>(at));
  full_.SetInverseNorm(at, SquaredNorm(values));
}

std::vector<float> RowStore::Read(std::int64_t row) const {
  std::vector<float> out(dim_);
  if (IsCompact(row)) {
    const std::int64_t at = CompactAt(row);
    FromCompact({compact_.At<std::int8_t>(at), out.size()}, scales_[at], out.data());
  } else {
    ReadFull(FullAt(row), out);
  }
  return out;
}

void RowStore::ReadHalf(std::int64_t row, std::span<std::uint16_t> out) const {
  CROSSNAV_CHECK(static_cast<int>(out.size()) == dim_, "one value per feature");
  ToHalf(Read(row), out.data());
}

void RowStore::WriteHalf(std::int64_t row, std::span<const std::uint16_t> values) {
  CROSSNAV_CHECK(static_cast<int>(values.size()) == dim_ && !IsCompact(row),
                 "one value per feature of a full row");
  std::vector<float> as_float(values.size());
  FromHalf(values, as_float.data());
  WriteFull(FullAt(row), as_float);
}

std::vector<float> RowStore::Cosines(std::span<const float> text) const {
  if (size() == 0) return {};
  CROSSNAV_CHECK(static_cast<int>(text.size()) == dim_, "text and rows are of one dimension");
  std::vector<float> unit(RowStride(dim_), 0.0f);
  const double squared = SquaredNorm(text);
  const double inverse = squared > 0 ? static_cast<float>(1.0 / std::sqrt(squared)) : 0.0f;
  for (int i = 0; i < dim_; ++i) unit[i] = static_cast<float>(text[i] * inverse);

  std::vector<float> cosines(size());
  FullCosines(unit, cosines);
  if (compact_.size() > 0) CompactCosines(unit, cosines);
  return cosines;
}

void RowStore::FullCosines(std::span<const float> unit, std::span<float> cosines) const {
  const int stride = RowStride(dim_);
  std::vector<float> scattered(IsPlain() ? 0 : RowPool::kChunkRows);
  for (std::int64_t begin = 0; begin < full_.size(); begin += RowPool::kChunkRows) {
    const std::int64_t end = std::min(begin + RowPool::kChunkRows, full_.size());
    const auto count = static_cast<std::size_t>(end - begin);
    float* dots = IsPlain() ? &cosines[begin] : scattered.data();
    if (is_half_)
      DotRows(full_.At<std::uint16_t>(begin), stride, count, unit.data(), dots);
    else
      DotRows(full_.At<float>(begin), stride, count, unit.data(), dots);
    for (std::size_t i = 0; i < count; ++i) dots[i] *= full_.InverseNorm(begin + i);
    if (!IsPlain())
      for (std::size_t i = 0; i < count; ++i) cosines[full_rows_[begin + i]] = dots[i];
  }
}

void RowStore::CompactCosines(std::span<const float> unit, std::span<float> cosines) const {
  const WholeText text = ToWhole(unit);
  std::vector<std::int32_t> dots(RowPool::kChunkRows);
  for (std::int64_t begin = 0; begin < compact_.size(); begin += RowPool::kChunkRows) {
    const std::int64_t end = std::min(begin + RowPool::kChunkRows, compact_.size());
    DotRows(compact_.At<std::int8_t>(begin), RowStride(dim_), static_cast<std::size_t>(end - begin),
            text.values.data(), dots.data());
    for (std::int64_t at = begin; at < end; ++at)
      cosines[compact_rows_[at]] =
          static_cast<float>(dots[at - begin]) * text.scale * compact_.InverseNorm(at);
  }
}

void RowStore::Keep(std::span<const std::int64_t> rows) {
  if (IsPlain()) {
    std::int64_t to = 0;
    for (std::int64_t from : rows) full_.Copy(from, to++);
    full_.Truncate(to);
    return;
  }
  auto kept = rows.begin();
  for (std::int64_t row = 0; row < size(); ++row) {
    if (kept != rows.end() && *kept == row)
      ++kept;
    else
      Remove(places_[row]);
  }
  Reorder(rows);
}

void RowStore::Reorder(std::span<const std::int64_t> order) {
  if (!IsPlain()) {
    Permute(places_, order);
    for (std::size_t row = 0; row < places_.size(); ++row) {
      const std::int32_t place = places_[row];
      (place < 0 ? compact_rows_[~place] : full_rows_[place]) = static_cast<std::int32_t>(row);
    }
    return;
  }
  // In-place permutation: follows each cycle with one row set aside, without a second copy of all
  // rows.
  std::vector<bool> is_placed(order.size(), false);
  const std::int64_t aside = order.empty() ? 0 : full_.Append();
  for (std::size_t start = 0; start < order.size(); ++start) {
    if (is_placed[start] || order[start] == static_cast<std::int64_t>(start)) continue;
    full_.Copy(static_cast<std::int64_t>(start), aside);
    std::size_t to = start;
    while (order[to] != static_cast<std::int64_t>(start)) {
      full_.Copy(order[to], static_cast<std::int64_t>(to));
      is_placed[to] = true;
      to = static_cast<std::size_t>(order[to]);
    }
    full_.Copy(aside, static_cast<std::int64_t>(to));
    is_placed[to] = true;
  }
  if (!order.empty()) full_.Truncate(aside);
}

}  // namespace crossnav::memory
