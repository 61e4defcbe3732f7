// SPDX-License-Identifier: MIT
#include "crossnav/memory/frame_lift.h"

#include <algorithm>
#include <cmath>

namespace crossnav::memory {

GridAxis GridAxis::Make(int pixels, int cells) {
  GridAxis axis;
  axis.cells = cells;
  axis.first.resize(pixels);
  axis.fraction.resize(pixels);
  axis.end.resize(static_cast<std::size_t>(cells));
  for (int p = 0; p < pixels; ++p) {
    const double x = std::clamp((p + 0.5) * cells / pixels - 0.5, 0.0, cells - 1.0);
    axis.first[p] = static_cast<std::int32_t>(std::floor(x));
    axis.fraction[p] = static_cast<float>(x - axis.first[p]);
    axis.end[static_cast<std::size_t>(axis.first[p])] = p + 1;
  }
  return axis;
}

void RowSums::Reset(const float* quality, const GridAxis& u) {
  quality_ = quality;
  fraction_ = u.fraction.data();
  before_.resize(u.first.size() + static_cast<std::size_t>(u.cells) + 1);
  int pixel = 0;
  for (std::size_t cell = 0; cell < u.end.size(); ++cell) {
    Sums* before = &before_[static_cast<std::size_t>(pixel) + cell];
    Sums sums;
    *before = sums;
    for (; pixel < u.end[cell]; ++pixel) {
      const double q = quality[pixel];
      sums.total += q;
      sums.right += q * fraction_[pixel];
      *++before = sums;
    }
  }
}

RowSums::Sums RowSums::Literally(int first, int last) const {
  Sums sums;
  for (int u = first; u <= last; ++u) {
    sums.total += quality_[u];
    sums.right += static_cast<double>(quality_[u]) * fraction_[u];
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

CellWeights::Corner& CellWeights::OtherCorner(Head& head, std::int32_t cell) {
  if (head.corner.cell < 0) {
    head.corner.cell = cell;
    return head.corner;
  }
  std::int32_t index = head.corner.next;
  while (index >= 0 && more_[index].cell != cell) index = more_[index].next;
  if (index < 0) {
    index = static_cast<std::int32_t>(more_.size());
    more_.push_back({cell, head.corner.next, {}});
    head.corner.next = index;
  }
  return more_[index];
}

void CellWeights::AddUp(const Corner& corner) {
  const int step_u = corner.cell % u_cells_ + 1 < u_cells_ ? 1 : 0;
  const int step_v = corner.cell / u_cells_ + 1 < v_cells_ ? u_cells_ : 0;
  const std::int32_t cells[4] = {corner.cell, corner.cell + step_u, corner.cell + step_v,
                                 corner.cell + step_u + step_v};
  for (int k = 0; k < 4; ++k) {
    if (corner.weight[k] <= 0) continue;
    if (dense_[cells[k]] == 0) touched_.push_back(cells[k]);
    dense_[cells[k]] += corner.weight[k];
  }
}

std::span<const CellShare> CellWeights::Shares(std::int32_t slot, double divisor) {
  const Head& head = heads_[slot];
  shares_.clear();
  const std::int32_t cell = head.corner.cell;
  if (head.corner.next < 0 && cell % u_cells_ + 1 < u_cells_ && cell / u_cells_ + 1 < v_cells_) {
    // One interval, as for most: the cells are different and in their order.
    const std::int32_t cells[4] = {cell, cell + 1, cell + u_cells_, cell + u_cells_ + 1};
    for (int k = 0; k < 4; ++k)
      if (const double weight = head.corner.weight[k]; weight > 0)
        shares_.push_back({cells[k], static_cast<float>(weight / divisor)});
    return shares_;
  }
  touched_.clear();
  for (std::int32_t i = head.corner.next; i >= 0; i = more_[i].next) AddUp(more_[i]);
  AddUp(head.corner);
  std::sort(touched_.begin(), touched_.end());
  for (const std::int32_t at : touched_) {
    shares_.push_back({at, static_cast<float>(dense_[at] / divisor)});
    dense_[at] = 0;
  }
  return shares_;
}

std::size_t CellWeights::Bytes() const {
  return heads_.capacity() * sizeof(Head) + more_.capacity() * sizeof(Corner) +
         dense_.capacity() * sizeof(double) + touched_.capacity() * sizeof(std::int32_t) +
         shares_.capacity() * sizeof(CellShare);
}

}  // namespace crossnav::memory
