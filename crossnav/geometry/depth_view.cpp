// SPDX-License-Identifier: MIT
#include "crossnav/geometry/depth_view.h"

#include <algorithm>
#include <array>

namespace crossnav::geometry {
namespace {

constexpr int kPad = 64;  // chosen: vectors may read past the last pixel

// Radii in tiles. Each is at most twice its predecessor, so that shifted copies of the predecessor
// leave no gap.
constexpr std::array<int, 11> kRadii = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24};

/// out[i] = max(in[i - by], in[i], in[i + by]) along a line, clamped at its ends.
void DilateLine(const float* in, int count, int by, float* out) {
  const auto at_edge = [&](int i) {
    out[i] = std::max({in[std::max(0, i - by)], in[i], in[std::min(count - 1, i + by)]});
  };
  for (int i = 0; i < std::min(by, count); ++i) at_edge(i);
  for (int i = by; i < count - by; ++i) out[i] = std::max(std::max(in[i - by], in[i + by]), in[i]);
  for (int i = std::max(by, count - by); i < count; ++i) at_edge(i);
}

}  // namespace

void DepthView::Resize(int width, int height) {
  width_ = width;
  height_ = height;
  reach_m_.resize(static_cast<std::size_t>(width) * height + kPad);
}

void DepthView::Fill() {
  if (levels_.empty()) levels_.resize(1);
  FillTiles();
  int count = 1;
  for (; levels_[count - 1].columns > 1 || levels_[count - 1].rows > 1; ++count) FillCoarser(count);
  levels_.resize(count);
  for (Level& level : levels_) FillWindows(level);
  dilations_.resize(kRadii.size() + 1);
  dilations_.back().is_filled = false;
  for (std::size_t i = 0; i < kRadii.size(); ++i) {
    dilations_[i].radius = kRadii[i];
    dilations_[i].is_filled = false;
  }
  max_reach_m_ = levels_.back().tile.empty() ? 0.0F : levels_.back().tile[0];
}

void DepthView::FillTiles() {
  Level& level = levels_[0];
  constexpr int kSide = 1 << kTileShift;
  level.columns = (width_ + kSide - 1) >> kTileShift;
  level.rows = (height_ + kSide - 1) >> kTileShift;
  level.tile.assign(static_cast<std::size_t>(level.columns) * level.rows, 0.0F);
  std::vector<float> column_max(static_cast<std::size_t>(level.columns) * kSide);
  for (int tv = 0; tv < level.rows; ++tv) {
    std::fill(column_max.begin(), column_max.end(), 0.0F);
    for (int v = tv * kSide; v < std::min(height_, (tv + 1) * kSide); ++v) {
      const float* row = &reach_m_[static_cast<std::size_t>(v) * width_];
      for (int u = 0; u < width_; ++u) column_max[u] = std::max(column_max[u], row[u]);
    }
    for (int tu = 0; tu < level.columns; ++tu) {
      const auto first = column_max.begin() + tu * kSide;
      level.tile[Index(level, tu, tv)] = *std::max_element(first, first + kSide);
    }
  }
}

void DepthView::FillCoarser(int index) {
  if (index >= static_cast<int>(levels_.size())) levels_.resize(index + 1);
  const Level& fine = levels_[index - 1];
  Level& level = levels_[index];
  level.columns = (fine.columns + 1) / 2;
  level.rows = (fine.rows + 1) / 2;
  level.tile.assign(static_cast<std::size_t>(level.columns) * level.rows, 0.0F);
  for (int tv = 0; tv < fine.rows; ++tv)
    for (int tu = 0; tu < fine.columns; ++tu) {
      float& to = level.tile[Index(level, tu / 2, tv / 2)];
      to = std::max(to, fine.tile[Index(fine, tu, tv)]);
    }
}

void DepthView::FillWindows(Level& level) {
  level.window.resize(level.tile.size());
  for (int tv = 0; tv < level.rows; ++tv) {
    const int next_v = std::min(tv + 1, level.rows - 1);
    for (int tu = 0; tu < level.columns; ++tu) {
      const int next_u = std::min(tu + 1, level.columns - 1);
      level.window[Index(level, tu, tv)] = std::max(
          {level.tile[Index(level, tu, tv)], level.tile[Index(level, next_u, tv)],
           level.tile[Index(level, tu, next_v)], level.tile[Index(level, next_u, next_v)]});
    }
  }
}

const float* DepthView::Dilated(double radius_px) {
  const double tiles = radius_px / (1 << kTileShift);
  for (std::size_t i = 0; i < kRadii.size(); ++i) {
    if (dilations_[i].radius < tiles) continue;
    if (!dilations_[i].is_filled) FillDilation(static_cast<int>(i));
    return dilations_[i].tile.data();
  }
  Dilation& everywhere = dilations_.back();
  if (!everywhere.is_filled) everywhere.tile.assign(levels_[0].tile.size(), max_reach_m_);
  everywhere.is_filled = true;
  return everywhere.tile.data();
}

void DepthView::FillDilation(int index) {
  if (index > 0 && !dilations_[index - 1].is_filled) FillDilation(index - 1);
  const std::vector<float>& from = index > 0 ? dilations_[index - 1].tile : levels_[0].tile;
  Dilation& to = dilations_[index];
  const int by = to.radius - (index > 0 ? dilations_[index - 1].radius : 0);
  const int columns = levels_[0].columns, rows = levels_[0].rows;
  to.tile.resize(from.size());
  scratch_.resize(from.size());
  for (int v = 0; v < rows; ++v)
    DilateLine(&from[Index(levels_[0], 0, v)], columns, by, &scratch_[Index(levels_[0], 0, v)]);
  for (int v = 0; v < rows; ++v) {
    const float* above = &scratch_[Index(levels_[0], 0, std::max(0, v - by))];
    const float* below = &scratch_[Index(levels_[0], 0, std::min(rows - 1, v + by))];
    const float* here = &scratch_[Index(levels_[0], 0, v)];
    float* out = &to.tile[Index(levels_[0], 0, v)];
    for (int u = 0; u < columns; ++u) out[u] = std::max(std::max(above[u], below[u]), here[u]);
  }
  to.is_filled = true;
}

float DepthView::MaxReach(const PixelRect& rect) const {
  // The finest level on which the rectangle touches at most 4 x 4 tiles.
  int shift = kTileShift, level = 0;
  while (std::max((rect.u1 >> shift) - (rect.u0 >> shift),
                  (rect.v1 >> shift) - (rect.v0 >> shift)) > 3) {
    ++shift;
    ++level;
  }
  const Level& tiles = levels_[level];
  const int u0 = rect.u0 >> shift, u1 = std::max(u0, (rect.u1 >> shift) - 1);
  const int v0 = rect.v0 >> shift, v1 = std::max(v0, (rect.v1 >> shift) - 1);
  return std::max(std::max(tiles.window[Index(tiles, u0, v0)], tiles.window[Index(tiles, u1, v0)]),
                  std::max(tiles.window[Index(tiles, u0, v1)], tiles.window[Index(tiles, u1, v1)]));
}

}  // namespace crossnav::geometry
