// SPDX-License-Identifier: MIT
// Lengths as numbers of cells; every conversion uses these functions. A plain floor(0.30 / 0.05) is
// 5 in double and 6 in float; these forgive a relative error of 1e-6, so that 0.30 / 0.05 is 6 in
// both.
#pragma once

#include <cmath>

namespace crossnav {

inline constexpr double kCellTolerance = 1e-6;  // chosen: above float error, below any real length

/// Whole cells that fit into `length` [same unit as `cell`].
inline int CellsFloor(double length, double cell) {
  return static_cast<int>(std::floor(length / cell + kCellTolerance));
}

/// Cells needed to cover `length`.
inline int CellsCeil(double length, double cell) {
  return static_cast<int>(std::ceil(length / cell - kCellTolerance));
}

/// Nearest whole number of cells; halves go up.
inline int CellsNearest(double length, double cell) {
  return static_cast<int>(std::floor(length / cell + 0.5 + kCellTolerance));
}

}  // namespace crossnav
