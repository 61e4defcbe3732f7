// SPDX-License-Identifier: MIT
#include "crossnav/memory/frame_lift.h"

#include <algorithm>
#include <cmath>

namespace crossnav::memory {

GridAxis GridAxis::Make(int pixels, int cells) {
  GridAxis axis;
  axis.cells = cells;
  axis.first.resize(pixels);
  axis.factors.resize(pixels);
  axis.end.resize(static_cast<std::size_t>(cells));
  for (int p = 0; p < pixels; ++p) {
    const double x = std::clamp((p + 0.5) * cells / pixels - 0.5, 0.0, cells - 1.0);
    axis.first[p] = static_cast<std::int32_t>(std::floor(x));
    axis.factors[p].fraction = static_cast<float>(x - axis.first[p]);
    axis.end[static_cast<std::size_t>(axis.first[p])] = p + 1;
  }
  return axis;
}

void RowSums::Reset(const float* quality, const GridAxis& u) {
  quality_ = quality;
  factors_ = u.factors.data();
  before_.resize(u.first.size() + static_cast<std::size_t>(u.cells) + 1);
  Sums* before = before_.data();
  std::int32_t pixel = 0;
  for (const std::int32_t end : u.end) {
    Sums sums;
    *before++ = sums;
    for (; pixel < end; ++pixel) {
      const double q = quality[pixel];
      const GridAxis::Factors factors = factors_[pixel];
      sums.total += q * factors.one;
      sums.right += q * factors.fraction;
      *before++ = sums;
    }
  }
}

RowSums::Sums RowSums::Literally(int first, int last) const {
  Sums sums;
  for (int u = first; u <= last; ++u) {
    sums.total += quality_[u];
    sums.right += quality_[u] * factors_[u].fraction;
  }
  return sums;
}

void CellWeights::Reset(const GridAxis& u, const GridAxis& v) {
  u_cells_ = u.cells;
  v_cells_ = v.cells;
  heads_.clear();
  more_.clear();
  dense_.assign(static_cast<std::size_t>(u_cells_) * v_cells_, 0.0);
}

std::int32_t CellWeights::AddSlot() {
  heads_.emplace_back();
  return size() - 1;
}

// Rows arrive from above and pixels from the left, but a voxel may extend to the left further down.
CellWeights::Patch& CellWeights::OtherPatch(Head& head, const Run& run) {
  Patch* patch = &head.patch;
  if (patch->v_cell != kNowhere) {
    std::int32_t index = patch->next;
    while (index >= 0 && !more_[index].Holds(run)) index = more_[index].next;
    if (index >= 0) return more_[index];
    more_.push_back({.next = patch->next});
    patch->next = static_cast<std::int32_t>(more_.size()) - 1;
    patch = &more_.back();
  }
  patch->v_cell = run.v_cell;
  patch->u_cell = run.u_cell - 1;
  return *patch;
}

void CellWeights::AddUp(const Patch& patch) {
  for (int v = 0; v < kPatchRows; ++v)
    for (int u = 0; u < kPatchCols; ++u) {
      const double weight = patch.weight[v][u];
      if (weight <= 0) continue;
      const std::int32_t cell = (patch.v_cell + v) * u_cells_ + patch.u_cell + u;
      if (dense_[cell] == 0) touched_.push_back(cell);
      dense_[cell] += weight;
    }
}

std::span<const CellShare> CellWeights::Shares(std::int32_t slot, double divisor) {
  const Patch& patch = heads_[slot].patch;
  const double factor = 1 / divisor;
  shares_.resize(kPatchRows * kPatchCols);
  if (patch.next < 0) {  // common case: the cells are distinct and in order
    std::size_t count = 0;
    for (int v = 0; v < kPatchRows; ++v)
      for (int u = 0; u < kPatchCols; ++u) {
        const double weight = patch.weight[v][u];
        shares_[count] = {(patch.v_cell + v) * u_cells_ + patch.u_cell + u,
                          static_cast<float>(weight * factor)};
        count += weight > 0 ? 1 : 0;
      }
    return {shares_.data(), count};
  }
  shares_.clear();
  touched_.clear();
  for (std::int32_t i = patch.next; i >= 0; i = more_[i].next) AddUp(more_[i]);
  AddUp(patch);
  std::sort(touched_.begin(), touched_.end());
  for (const std::int32_t at : touched_) {
    shares_.push_back({at, static_cast<float>(dense_[at] * factor)});
    dense_[at] = 0;
  }
  return shares_;
}

std::size_t CellWeights::Bytes() const {
  return heads_.capacity() * sizeof(Head) + more_.capacity() * sizeof(Patch) +
         dense_.capacity() * sizeof(double) + touched_.capacity() * sizeof(std::int32_t) +
         shares_.capacity() * sizeof(CellShare);
}

}  // namespace crossnav::memory
