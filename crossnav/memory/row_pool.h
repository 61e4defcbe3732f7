// SPDX-License-Identifier: MIT
// Rows of one element size in chunks that never move: growing costs no copy and no second buffer.
// The owner defines the content of a row; each row has a factor. Readers may share it while nobody
// writes.
#pragma once

#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {

/// Asks the system to back `bytes` at `begin` with huge pages where possible: a query reads every
/// row once, and small pages cost a third of its time. No effect on results.
void AdviseHugePages(void* begin, std::size_t bytes);

class RowPool {
 public:
  static constexpr std::int64_t kChunkRows = 4096;  // chosen: three huge pages at 768 halves

  RowPool(std::size_t element_bytes, int dim) : element_bytes_(element_bytes), dim_(dim) {}

  void SetDim(int dim);  ///< only while empty
  std::int64_t size() const { return static_cast<std::int64_t>(inverse_norms_.size()); }
  std::size_t RowBytes() const {
    return static_cast<std::size_t>(RowStride(dim_)) * element_bytes_;
  }
  std::int64_t Bytes() const;

  std::int64_t Append();  ///< a row of zeros; returns its number
  void Copy(std::int64_t from, std::int64_t to);
  void Truncate(std::int64_t size);

  /// Elements of a row; rows of one chunk are adjacent.
  template <class T>
  T* At(std::int64_t row) const {
    return reinterpret_cast<T*>(chunks_[row / kChunkRows].get() + (row % kChunkRows) * RowBytes());
  }
  void Prefetch(std::int64_t row) const;  ///< prefetches the row
  float InverseNorm(std::int64_t row) const { return inverse_norms_[row]; }
  void SetInverseNorm(std::int64_t row, double squared_norm);  ///< 0 for a row of zeros

 private:
  static constexpr std::size_t kAlignment = std::size_t{2} << 20;  // a huge page
  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(kAlignment)); }
  };

  std::size_t element_bytes_;
  int dim_;
  std::vector<std::unique_ptr<std::byte[], Free>> chunks_;
  std::vector<float> inverse_norms_;
};

}  // namespace crossnav::memory
