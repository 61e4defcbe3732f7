// SPDX-License-Identifier: MIT
// Feature rows in chunks that never move: growing costs no copy and no second buffer. Rows are half
// precision by default (float32 for comparison), with the inverse norm of what is stored kept
// beside them. Readers may share it while nobody writes.
#pragma once

#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {

/// Asks the system to back `bytes` at `begin` with huge pages, where it can: a query reads every
/// row once, and small pages cost it a third. No effect on results.
void AdviseHugePages(void* begin, std::size_t bytes);

class RowStore {
 public:
  explicit RowStore(bool is_half, int dim = 0);

  bool is_half() const { return is_half_; }
  int dim() const { return dim_; }
  void SetDim(int dim);  ///< only while empty

  std::int64_t size() const { return static_cast<std::int64_t>(inverse_norms_.size()); }
  std::int64_t Bytes() const;

  std::int64_t Append();  ///< a row of zeros; returns its index

  /// row = keep * row + sum of shares (see FuseRow).
  void Fuse(std::int64_t row, float keep, const float* grid, std::span<const CellShare> shares);

  std::vector<float> Read(std::int64_t row) const;
  /// Half-precision bit patterns, `dim` of them; float rows are rounded.
  void ReadHalf(std::int64_t row, std::span<std::uint16_t> out) const;
  void WriteHalf(std::int64_t row, std::span<const std::uint16_t> values);

  /// Cosine of every row with `text`; rows or texts of norm 0 give 0.
  std::vector<float> Cosines(std::span<const float> text) const;

  /// Keeps only the rows listed, ascending; they move down.
  void Keep(std::span<const std::int64_t> rows);
  /// Row i becomes what row order[i] was; a permutation.
  void Reorder(std::span<const std::int64_t> order);

 private:
  static constexpr std::int64_t kChunkRows = 4096;  // chosen: three huge pages at 768 features
  static constexpr std::size_t kAlignment = std::size_t{2} << 20;  // a huge page
  struct Free {
    void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t(kAlignment)); }
  };
  using Chunk = std::unique_ptr<std::byte[], Free>;

  std::size_t RowBytes() const {
    return static_cast<std::size_t>(RowStride(dim_)) * (is_half_ ? 2 : 4);
  }
  std::byte* At(std::int64_t row) const {
    return chunks_[row / kChunkRows].get() + (row % kChunkRows) * RowBytes();
  }
  std::uint16_t* HalfAt(std::int64_t row) const {
    return reinterpret_cast<std::uint16_t*>(At(row));
  }
  float* FloatAt(std::int64_t row) const { return reinterpret_cast<float*>(At(row)); }

  bool is_half_;
  int dim_;
  std::vector<Chunk> chunks_;
  std::vector<float> inverse_norms_;  // 0 for a row of zeros
};

}  // namespace crossnav::memory
