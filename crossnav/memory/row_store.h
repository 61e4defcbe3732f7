// SPDX-License-Identifier: MIT
// Feature rows of a memory. A row is full (half precision by default, float32 for comparison) or
// compact: int8 with one factor, half the bytes; compaction changes a row by a 1 - cosine of at
// most dim / 125000, in practice a hundred times less. Fusing into a compact row makes it full
// again. The inverse norm of the stored values is kept beside each row. Readers may share it while
// nobody writes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/memory/row_kernels.h"
#include "crossnav/memory/row_pool.h"

namespace crossnav::memory {

class RowStore {
 public:
  explicit RowStore(bool is_half, int dim = 0);

  int dim() const { return dim_; }
  void SetDim(int dim);  ///< only while empty

  std::int64_t size() const {
    return IsPlain() ? full_.size() : static_cast<std::int64_t>(places_.size());
  }
  std::int64_t CompactCount() const { return compact_.size(); }
  std::int64_t Bytes() const;

  std::int64_t Append();  ///< a full row of zeros; returns its index

  /// row = keep * row + sum of shares (see FuseRow).
  void Fuse(std::int64_t row, float keep, const float* grid, std::span<const CellShare> shares);

  /// Prefetches the row for a later Fuse.
  void Prefetch(std::int64_t row) const {
    if (!IsCompact(row)) full_.Prefetch(FullAt(row));
  }

  std::vector<float> Read(std::int64_t row) const;
  /// Half-precision bit patterns, `dim` of them; float rows are rounded.
  void ReadHalf(std::int64_t row, std::span<std::uint16_t> out) const;
  void WriteHalf(std::int64_t row, std::span<const std::uint16_t> values);

  bool IsCompact(std::int64_t row) const { return !IsPlain() && places_[row] < 0; }
  void Compact(std::int64_t row);  ///< no effect on a compact row
  /// int8 values of a compact row; returns its factor.
  float ReadCompact(std::int64_t row, std::span<std::int8_t> out) const;
  void WriteCompact(std::int64_t row, std::span<const std::int8_t> values, float scale);

  /// Cosine of every row with `text`; rows or texts of norm 0 give 0.
  std::vector<float> Cosines(std::span<const float> text) const;

  /// Keeps only the listed rows, ascending; they move down.
  void Keep(std::span<const std::int64_t> rows);
  /// Row i becomes the former row order[i]; `order` is a permutation.
  void Reorder(std::span<const std::int64_t> order);

 private:
  // Until the first row is compacted, row i is number i of full_ and the tables below are empty.
  bool IsPlain() const { return places_.empty(); }
  void LeavePlain();

  std::int32_t AppendFull(std::int32_t row);
  std::int32_t AppendCompact(std::int32_t row, float scale);
  void Remove(std::int32_t place);  // the last row of its pool takes its place
  void Expand(std::int64_t row);

  std::int64_t FullAt(std::int64_t row) const { return IsPlain() ? row : places_[row]; }
  std::int64_t CompactAt(std::int64_t row) const { return ~places_[row]; }
  void ReadFull(std::int64_t at, std::span<float> out) const;
  void WriteFull(std::int64_t at, std::span<const float> values);
  void FullCosines(std::span<const float> unit, std::span<float> cosines) const;
  void CompactCosines(std::span<const float> unit, std::span<float> cosines) const;

  bool is_half_;
  int dim_;
  RowPool full_, compact_;
  std::vector<float> scales_;         // of compact_
  std::vector<std::int32_t> places_;  // per row: number in full_, or ~ in compact_
  std::vector<std::int32_t> full_rows_, compact_rows_;  // the row at each number
};

}  // namespace crossnav::memory
