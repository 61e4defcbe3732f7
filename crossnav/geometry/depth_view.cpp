// SPDX-License-Identifier: MIT
#include "crossnav/geometry/depth_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace crossnav::geometry {

void DepthView::Reset(const DepthImage& depth_m, const MapConfig& config) {
  width_ = depth_m.width;
  height_ = depth_m.height;
  reach_m_.resize(depth_m.data.size());
  // The same comparisons as ReachOf, in float: a float is below a double limit exactly where it is
  // below the limit rounded up to a float.
  auto least = static_cast<float>(config.depth_min_m);
  if (least < config.depth_min_m)
    least = std::nextafterf(least, std::numeric_limits<float>::infinity());
  const auto most = static_cast<float>(config.depth_max_m);
  for (std::size_t i = 0; i < reach_m_.size(); ++i) {
    const float z = depth_m.data[i];
    const bool says = z >= least && z > 0 && z <= std::numeric_limits<float>::max();
    reach_m_[i] = says ? std::min(z, most) : 0.0F;
  }
  levels_.resize(1);
  FillTiles();
  while (levels_.back().columns > 1 || levels_.back().rows > 1)
    FillCoarser(static_cast<int>(levels_.size()));
  for (Level& level : levels_) FillWindows(level);
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
  levels_.emplace_back();
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

float DepthView::MaxReach(const PixelRect& rect) const {
  const auto longer = static_cast<unsigned>(std::max(rect.u1 - rect.u0, rect.v1 - rect.v0));
  const int level = std::max(0, static_cast<int>(std::bit_width(longer)) - kTileShift);
  if (level >= static_cast<int>(levels_.size())) return max_reach_m_;
  const int shift = kTileShift + level;
  return levels_[level].window[Index(levels_[level], rect.u0 >> shift, rect.v0 >> shift)];
}

}  // namespace crossnav::geometry
