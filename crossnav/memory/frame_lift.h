// SPDX-License-Identifier: MIT
// One frame's features, gathered per voxel without ever building the upsampled tensor. Bilinear
// interpolation is linear, so a voxel's weighted mean over its pixels (eq:intra_frame_fusion) is a
// weighted mean over the few grid cells those pixels touch; only these scalar weights are summed
// here. Along a run of pixels in one voxel and one cell interval the horizontal fraction enters
// linearly too, so a run costs two sums and four additions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {

/// Where image columns (or rows) fall in the grid: half-pixel centres, edges clamped.
struct GridAxis {
  struct Factors {  // adjacent, to be multiplied at once
    double one = 1;
    double fraction = 0;  ///< [0, 1) towards the next cell, rounded to float
  };
  std::vector<std::int32_t> first;  ///< lower cell of the interval, per pixel
  std::vector<Factors> factors;     ///< per pixel
  std::vector<std::int32_t> end;    ///< first pixel behind the interval, per lower cell
  int cells = 0;

  static GridAxis Make(int pixels, int cells);
};

/// Prefix sums of an image row: sums over neighbouring pixels of one cell interval, each by two
/// subtractions.
class RowSums {
 public:
  /// `quality`: values of the row, one for each pixel of `u`; kept by reference.
  void Reset(const float* quality, const GridAxis& u);

  struct Sums {
    double total = 0, right = 0;  ///< sum q, sum q * fraction
  };
  /// Pixels first..last of interval `cell`.
  Sums Of(int first, int last, std::int32_t cell) const {
    const Sums& from = before_[first + cell];
    const Sums& to = before_[last + cell + 1];
    const Sums sums{to.total - from.total, to.right - from.right};
    return sums.total > kLost * to.total ? sums : Literally(first, last);
  }

 private:
  // chosen: far above the rounding of a sum, so that faint pixels beside bright pixels count.
  static constexpr double kLost = 1e-8;
  Sums Literally(int first, int last) const;

  const float* quality_ = nullptr;
  const GridAxis::Factors* factors_ = nullptr;
  std::vector<Sums> before_;  // by pixel + interval: each interval has one extra place
};

/// Weights of the grid cells that each voxel touches. Slots number the voxels of a frame from 0.
class CellWeights {
 public:
  void Reset(const GridAxis& u, const GridAxis& v);

  /// Adds a slot and returns its number.
  std::int32_t AddSlot();
  std::int32_t size() const { return static_cast<std::int32_t>(heads_.size()); }

  /// Adds a run of pixels of one image row: `total` = sum q, `right` = sum q * fraction.
  struct Run {
    int u_cell = 0, v_cell = 0;
    double v_fraction = 0;
    double total = 0, right = 0;
  };
  void Add(std::int32_t slot, const Run& run) {
    Head& head = heads_[slot];
    head.total += run.total;
    Patch& patch = head.patch.Holds(run) ? head.patch : OtherPatch(head, run);
    double* upper = patch.weight[run.v_cell - patch.v_cell] + (run.u_cell - patch.u_cell);
    double* lower = upper + kPatchCols;
    const double left = run.total - run.right;
    const double below = run.v_fraction, above = 1.0 - below;
    upper[0] += above * left;
    upper[1] += above * run.right;
    lower[0] += below * left;
    lower[1] += below * run.right;
  }

  double Total(std::int32_t slot) const { return heads_[slot].total; }  ///< sum of q
  /// Distinct cells, each with weight / `divisor`; valid until the next call.
  std::span<const CellShare> Shares(std::int32_t slot, double divisor);

  std::size_t Bytes() const;

 private:
  // Patch of neighbouring cells, sized for the intervals of most voxels. Cells outside the grid
  // have weight zero, because fractions at the grid's edge are zero.
  static constexpr int kPatchRows = 3, kPatchCols = 4;
  struct Patch {
    std::int32_t v_cell = kNowhere, u_cell = kNowhere;  // of weight[0][0]
    double weight[kPatchRows][kPatchCols] = {};
    std::int32_t next = -1;  // in more_

    bool Holds(const Run& run) const {
      return static_cast<std::uint32_t>(run.v_cell - v_cell) < kPatchRows - 1 &&
             static_cast<std::uint32_t>(run.u_cell - u_cell) < kPatchCols - 1;
    }
  };
  static constexpr std::int32_t kNowhere = -1000000;
  struct Head {
    double total = 0;
    Patch patch;
  };
  Patch& OtherPatch(Head& head, const Run& run);  // made if absent
  void AddUp(const Patch& patch);

  int u_cells_ = 0, v_cells_ = 0;
  std::vector<Head> heads_;
  std::vector<Patch> more_;    // further patches of voxels near the camera
  std::vector<double> dense_;  // per grid cell, zero between calls
  std::vector<std::int32_t> touched_;
  std::vector<CellShare> shares_;
};

}  // namespace crossnav::memory
