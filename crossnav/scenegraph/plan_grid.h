// SPDX-License-Identifier: MIT
// A window of the map seen from above: one value for each column of voxels.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace crossnav::scenegraph {

/// Columns x0 <= x < x0 + width and likewise y, in voxel indices.
struct GridFrame {
  int x0 = 0, y0 = 0, width = 0, height = 0;

  bool Holds(int x, int y) const { return x >= x0 && y >= y0 && x < x0 + width && y < y0 + height; }
  std::size_t IndexOf(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x - x0);
  }
  int XOf(std::size_t index) const { return x0 + static_cast<int>(index) % width; }
  int YOf(std::size_t index) const { return y0 + static_cast<int>(index) / width; }
  std::size_t Size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  friend bool operator==(const GridFrame&, const GridFrame&) = default;
};

template <class T>
struct PlanGrid {
  GridFrame frame;
  std::vector<T> cells;  ///< row by row

  PlanGrid() = default;
  PlanGrid(const GridFrame& of, const T& value) : frame(of), cells(of.Size(), value) {}

  /// `outside`: the value beyond the window.
  T At(int x, int y, const T& outside = {}) const {
    return frame.Holds(x, y) ? cells[frame.IndexOf(x, y)] : outside;
  }
};

struct GridStep {
  int dx = 0, dy = 0;
};
inline constexpr std::array<GridStep, 4> kSides = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
inline constexpr std::array<GridStep, 8> kAround = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// Calls visit(index) for the cells of `grid` adjacent to cell `index`.
template <class Steps, class F>
void ForEachBeside(const GridFrame& frame, std::size_t index, const Steps& steps, F&& visit) {
  const int x = frame.XOf(index), y = frame.YOf(index);
  for (const GridStep& step : steps)
    if (frame.Holds(x + step.dx, y + step.dy)) visit(frame.IndexOf(x + step.dx, y + step.dy));
}

}  // namespace crossnav::scenegraph
