// SPDX-License-Identifier: MIT
// A depth image made ready for tests against boxes: how far each pixel's ray reaches, and the
// greatest reach within windows of pixels of every size. Internal to the map.
#pragma once

#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/geometry/map_config.h"

namespace crossnav::geometry {

/// Pixels u0..u1, v0..v1, both ends included; empty if u0 > u1 or v0 > v1.
struct PixelRect {
  int u0 = 0, v0 = 0, u1 = -1, v1 = -1;
  bool empty() const { return u0 > u1 || v0 > v1; }
};

class DepthView {
 public:
  static constexpr int kTileShift = 3;  ///< tiles of 8 x 8 pixels

  /// Reads the image; keeps its buffers between frames.
  void Reset(const DepthImage& depth_m, const MapConfig& config);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Depth up to which the pixel's ray is known [m]; 0 = it says nothing.
  float ReachAt(int u, int v) const { return reach_m_[static_cast<std::size_t>(v) * width_ + u]; }

  const float* Row(int v) const { return &reach_m_[static_cast<std::size_t>(v) * width_]; }

  /// At least the greatest reach in `rect`, which is not empty. Cost O(1).
  float MaxReach(const PixelRect& rect) const;

  /// The greatest reach in the tile (tu, tv).
  float TileReach(int tu, int tv) const { return levels_[0].tile[Index(levels_[0], tu, tv)]; }

  float MaxReach() const { return max_reach_m_; }

 private:
  // Level k has tiles of 8 << k pixels. A window is 2 x 2 tiles, so that every rectangle not larger
  // than a tile lies in the window of its first tile.
  struct Level {
    int columns = 0, rows = 0;
    std::vector<float> tile, window;
  };
  static std::size_t Index(const Level& level, int tu, int tv) {
    return static_cast<std::size_t>(tv) * level.columns + tu;
  }
  void FillTiles();
  void FillCoarser(int level);
  static void FillWindows(Level& level);

  int width_ = 0, height_ = 0;
  float max_reach_m_ = 0;
  std::vector<float> reach_m_;
  std::vector<Level> levels_;
};

}  // namespace crossnav::geometry
