// SPDX-License-Identifier: MIT
#include "crossnav/memory/row_pool.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cmath>
#include <cstring>

#include "crossnav/core/check.h"
#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {

void AdviseHugePages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // A refusal of the advice affects speed only.
  (void)madvise(begin, bytes, MADV_HUGEPAGE);
#endif
}

void RowPool::SetDim(int dim) {
  CROSSNAV_CHECK(size() == 0 && dim > 0, "the dimension is fixed once there are rows");
  chunks_.clear();
  dim_ = dim;
}

std::int64_t RowPool::Bytes() const {
  return static_cast<std::int64_t>(chunks_.size() * kChunkRows * RowBytes() +
                                   inverse_norms_.capacity() * sizeof(float));
}

std::int64_t RowPool::Append() {
  const std::int64_t row = size();
  if (row == static_cast<std::int64_t>(chunks_.size()) * kChunkRows) {
    const std::size_t bytes = kChunkRows * RowBytes();
    chunks_.emplace_back(new (std::align_val_t(kAlignment)) std::byte[bytes]);
    AdviseHugePages(chunks_.back().get(), bytes);
  }
  std::memset(At<std::byte>(row), 0, RowBytes());
  inverse_norms_.push_back(0);
  return row;
}

void RowPool::Copy(std::int64_t from, std::int64_t to) {
  if (from == to) return;
  std::memcpy(At<std::byte>(to), At<std::byte>(from), RowBytes());
  inverse_norms_[to] = inverse_norms_[from];
}

void RowPool::Truncate(std::int64_t size) {
  inverse_norms_.resize(size);
  // One chunk is kept: a row that comes and goes costs no allocation.
  const auto needed = static_cast<std::size_t>((size + kChunkRows - 1) / kChunkRows);
  if (chunks_.size() > needed + 1) chunks_.resize(needed + 1);
}

void RowPool::Prefetch(std::int64_t row) const {
  PrefetchBytes(At<std::byte>(row), RowBytes());
}

void RowPool::SetInverseNorm(std::int64_t row, double squared_norm) {
  inverse_norms_[row] = squared_norm > 0 ? static_cast<float>(1.0 / std::sqrt(squared_norm)) : 0.0f;
}

}  // namespace crossnav::memory
