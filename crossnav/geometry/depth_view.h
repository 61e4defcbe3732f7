// SPDX-License-Identifier: MIT
// A depth image made ready for tests against boxes: how far each pixel's ray reaches, and the
// greatest reach within windows of pixels of every size. Internal to the map.
#pragma once

#include <vector>

namespace crossnav::geometry {

/// Pixels u0..u1, v0..v1, both ends included; empty if u0 > u1 or v0 > v1.
struct PixelRect {
  int u0 = 0, v0 = 0, u1 = -1, v1 = -1;
  bool empty() const { return u0 > u1 || v0 > v1; }
};

class DepthView {
 public:
  static constexpr int kTileShift = 2;  ///< finest tiles: 4 x 4 pixels

  /// Makes room for an image; buffers are kept between frames.
  void Resize(int width, int height);

  /// Fills the tiles once every row has been written.
  void Fill();

  int width() const { return width_; }
  int height() const { return height_; }

  /// Depth up to which the pixel's ray is known [m]; 0 = invalid pixel.
  float ReachAt(int u, int v) const { return reach_m_[static_cast<std::size_t>(v) * width_ + u]; }

  float* Row(int v) { return &reach_m_[static_cast<std::size_t>(v) * width_]; }
  const float* Row(int v) const { return &reach_m_[static_cast<std::size_t>(v) * width_]; }

  /// At least the greatest reach in `rect`, which is not empty; pixels up to a third of its size
  /// around it may count. Cost O(1).
  float MaxReach(const PixelRect& rect) const;

  /// The greatest reach in the tile (tu, tv).
  float TileReach(int tu, int tv) const { return levels_[0].tile[Index(levels_[0], tu, tv)]; }

  float MaxReach() const { return max_reach_m_; }

  /// Per finest tile, row by row: at least the greatest reach within `radius_px` of each of its
  /// pixels. Computed at the first request in a frame.
  const float* Dilated(double radius_px);

  int tile_columns() const { return levels_[0].columns; }

 private:
  // Level k has tiles of 4 << k pixels, and windows of 2 x 2 tiles: four windows cover a rectangle
  // of up to 4 x 4 tiles.
  struct Level {
    int columns = 0, rows = 0;
    std::vector<float> tile, window;
  };
  static std::size_t Index(const Level& level, int tu, int tv) {
    return static_cast<std::size_t>(tv) * level.columns + tu;
  }
  // The finest tiles dilated by `radius` tiles.
  struct Dilation {
    int radius = 0;
    bool is_filled = false;
    std::vector<float> tile;
  };
  void FillDilation(int index);
  void FillTiles();
  void FillCoarser(int level);
  static void FillWindows(Level& level);

  int width_ = 0, height_ = 0;
  float max_reach_m_ = 0;
  std::vector<float> reach_m_;
  std::vector<Level> levels_;
  std::vector<Dilation> dilations_;  ///< radii grow; the last entry serves any radius
  std::vector<float> scratch_;
};

}  // namespace crossnav::geometry
