// SPDX-License-Identifier: MIT
// Inner loops of the memory, compiled for several instruction sets and chosen at run time
// (Highway).
//
// Scalar code, one element at a time:
//   FuseRow    row[i] = keep * row[i] + sum_j share_j * grid[cell_j * dim + i], rounded to the type
//   DotRows    out[r] = sum_i row_r[i] * text[i]
//   ToCompact  scale = max |in| / 127, out[i] = nearest(in[i] / scale)
//   QualityRow (1 - tanh(gamma * scale * |gradient|)) * exp(-(d0 - depth)^2 / (3 sigma_d^2)),
//              gradient = half the difference of both valid neighbours, or the one-sided difference
// References: tests/memory/literal_memory.h in double precision (LiteralReferenceTest,
// ObservationQualityTest); RowKernelsTest compares instruction sets byte by byte.
//
// Sums run over 32 fixed virtual lanes, so that AVX2 and AVX-512 give the same bytes. Rows are half
// precision (bit patterns), float32 or int8, padded with zeros to a multiple of kRowPad. int8
// arithmetic uses integers and is exact everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace crossnav::memory {

inline constexpr int kRowPad = 32;  ///< [elements]

/// Elements of a stored row of `dim` features.
constexpr int RowStride(int dim) {
  return (dim + kRowPad - 1) / kRowPad * kRowPad;
}

/// Share of one grid cell in a voxel's new feature.
struct CellShare {
  std::int32_t cell = 0;  ///< row * cols + col
  float share = 0;
};

/// row = keep * row + sum_i share_i * grid[cell_i], rounded to the row's type. Returns the squared
/// norm of the stored row. `grid` holds cells of `dim` floats, not padded.
float FuseRow(std::uint16_t* row, int dim, float keep, const float* grid,
              std::span<const CellShare> shares);
float FuseRow(float* row, int dim, float keep, const float* grid,
              std::span<const CellShare> shares);

/// Prefetches the cache line that holds `p`.
inline void PrefetchLine(const void* p) {
  __builtin_prefetch(p);
}
/// Prefetches these bytes.
void PrefetchBytes(const std::byte* begin, std::size_t bytes);

/// out[i] = rows[i] . text, `count` rows of `stride` elements; `text` is padded likewise.
void DotRows(const std::uint16_t* rows, int stride, std::size_t count, const float* text,
             float* out);
void DotRows(const float* rows, int stride, std::size_t count, const float* text, float* out);

/// Dot products of int8 rows with an integer text. Exact if sum |text_i| <= kMaxCompactText, so
/// that no partial sum overflows.
void DotRows(const std::int8_t* rows, int stride, std::size_t count, const std::int16_t* text,
             std::int32_t* out);
inline constexpr std::int32_t kMaxCompactText = 0x7fffffff / 127;

/// Row as int8: value_i is scale * out_i to half a scale, |out_i| <= 127. Returns the scale: the
/// largest absolute value / 127, or 1 for a row of zeros.
float ToCompact(std::span<const float> in, std::int8_t* out);
void FromCompact(std::span<const std::int8_t> in, float scale, float* out);

/// Bit patterns of the nearest half-precision numbers, and back; finite values stay finite.
void ToHalf(std::span<const float> in, std::uint16_t* out);
void FromHalf(std::span<const std::uint16_t> in, float* out);

/// True if every value is finite.
bool AllFinite(std::span<const float> values);

/// Constants of eq:supp_observation_quality in the kernel's form.
struct QualityFactors {
  float gradient = 0;        ///< 2 gamma gradient_scale log2(e)
  float preferred_m = 0;     ///< d0
  float inverse_spread = 0;  ///< log2(e) / (3 sigma_d^2)
};

/// out[i] = in[i] where it is a valid depth (> 0 and finite), else 0.
void CopyValidDepth(const float* in, int width, float* out);

/// Quality of one image row of `width` pixels. The three depth rows carry one zero before and
/// after, and zero where depth is invalid; `row[1]` is pixel 0.
struct DepthRows {
  const float* above;
  const float* row;
  const float* below;
};
void QualityRow(const DepthRows& depth, int width, const QualityFactors& factors, float* quality);

/// Name of the instruction set in use, e.g. "AVX3".
const char* KernelTarget();

}  // namespace crossnav::memory
