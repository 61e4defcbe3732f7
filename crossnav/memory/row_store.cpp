// SPDX-License-Identifier: MIT
#include "crossnav/memory/row_store.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>

#include "crossnav/core/check.h"

namespace crossnav::memory {
namespace {

float InverseNorm(double squared_norm) {
  return squared_norm > 0 ? static_cast<float>(1.0 / std::sqrt(squared_norm)) : 0.0f;
}

double SquaredNorm(std::span<const float> v) {
  double sum = 0;
  for (float x : v) sum += static_cast<double>(x) * x;
  return sum;
}

}  // namespace

void AdviseHugePages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // Only advice: a refusal changes speed alone.
  (void)madvise(begin, bytes, MADV_HUGEPAGE);
#endif
}

RowStore::RowStore(bool is_half, int dim) : is_half_(is_half), dim_(dim) {}

void RowStore::SetDim(int dim) {
  CROSSNAV_CHECK(size() == 0 && dim > 0, "the dimension is fixed once there are rows");
  chunks_.clear();
  dim_ = dim;
}

std::int64_t RowStore::Bytes() const {
  return static_cast<std::int64_t>(chunks_.size() * kChunkRows * RowBytes() +
                                   inverse_norms_.capacity() * sizeof(float));
}

std::int64_t RowStore::Append() {
  const std::int64_t row = size();
  if (row == static_cast<std::int64_t>(chunks_.size()) * kChunkRows) {
    const std::size_t bytes = kChunkRows * RowBytes();
    chunks_.emplace_back(new (std::align_val_t(kAlignment)) std::byte[bytes]);
    AdviseHugePages(chunks_.back().get(), bytes);
  }
  std::memset(At(row), 0, RowBytes());
  inverse_norms_.push_back(0);
  return row;
}

void RowStore::Fuse(std::int64_t row, float keep, const float* grid,
                    std::span<const CellShare> shares) {
  const float squared = is_half_ ? FuseRow(HalfAt(row), dim_, keep, grid, shares)
                                 : FuseRow(FloatAt(row), dim_, keep, grid, shares);
  inverse_norms_[row] = InverseNorm(squared);
}

std::vector<float> RowStore::Read(std::int64_t row) const {
  std::vector<float> out(dim_);
  if (is_half_)
    FromHalf({HalfAt(row), out.size()}, out.data());
  else
    std::copy_n(FloatAt(row), dim_, out.data());
  return out;
}

void RowStore::ReadHalf(std::int64_t row, std::span<std::uint16_t> out) const {
  CROSSNAV_CHECK(static_cast<int>(out.size()) == dim_, "one value per feature");
  if (is_half_)
    std::copy_n(HalfAt(row), dim_, out.data());
  else
    ToHalf({FloatAt(row), out.size()}, out.data());
}

void RowStore::WriteHalf(std::int64_t row, std::span<const std::uint16_t> values) {
  CROSSNAV_CHECK(static_cast<int>(values.size()) == dim_, "one value per feature");
  std::vector<float> as_float(values.size());
  FromHalf(values, as_float.data());
  if (is_half_)
    std::copy(values.begin(), values.end(), HalfAt(row));
  else
    std::copy(as_float.begin(), as_float.end(), FloatAt(row));
  inverse_norms_[row] = InverseNorm(SquaredNorm(as_float));
}

std::vector<float> RowStore::Cosines(std::span<const float> text) const {
  if (size() == 0) return {};
  CROSSNAV_CHECK(static_cast<int>(text.size()) == dim_, "text and rows are of one dimension");
  const int stride = RowStride(dim_);
  std::vector<float> unit(stride, 0.0f);
  const double inverse = InverseNorm(SquaredNorm(text));
  for (int i = 0; i < dim_; ++i) unit[i] = static_cast<float>(text[i] * inverse);

  std::vector<float> cosines(size());
  for (std::int64_t begin = 0; begin < size(); begin += kChunkRows) {
    const std::int64_t end = std::min(begin + kChunkRows, size());
    const auto count = static_cast<std::size_t>(end - begin);
    if (is_half_)
      DotRows(HalfAt(begin), stride, count, unit.data(), &cosines[begin]);
    else
      DotRows(FloatAt(begin), stride, count, unit.data(), &cosines[begin]);
    for (std::int64_t row = begin; row < end; ++row) cosines[row] *= inverse_norms_[row];
  }
  return cosines;
}

void RowStore::Keep(std::span<const std::int64_t> rows) {
  std::int64_t to = 0;
  for (std::int64_t from : rows) {
    if (from != to) {
      std::memcpy(At(to), At(from), RowBytes());
      inverse_norms_[to] = inverse_norms_[from];
    }
    ++to;
  }
  inverse_norms_.resize(to);
  chunks_.resize((to + kChunkRows - 1) / kChunkRows);
}

// Along each cycle of the permutation, with one row set aside: no second copy of all rows.
void RowStore::Reorder(std::span<const std::int64_t> order) {
  std::vector<bool> is_placed(order.size(), false);
  std::vector<std::byte> aside(RowBytes());
  for (std::size_t start = 0; start < order.size(); ++start) {
    if (is_placed[start] || order[start] == static_cast<std::int64_t>(start)) continue;
    std::memcpy(aside.data(), At(start), RowBytes());
    const float aside_norm = inverse_norms_[start];
    std::size_t to = start;
    while (order[to] != static_cast<std::int64_t>(start)) {
      const std::int64_t from = order[to];
      std::memcpy(At(to), At(from), RowBytes());
      inverse_norms_[to] = inverse_norms_[from];
      is_placed[to] = true;
      to = from;
    }
    std::memcpy(At(to), aside.data(), RowBytes());
    inverse_norms_[to] = aside_norm;
    is_placed[to] = true;
  }
}

}  // namespace crossnav::memory
