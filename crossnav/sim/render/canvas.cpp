// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/canvas.h"

namespace crossnav::sim {

void Canvas::Clear(int width_px, int height_px) {
  width = width_px;
  height = height_px;
  stride = (width + 15) / 8 * 8;
  const std::size_t pixels = static_cast<std::size_t>(stride) * static_cast<std::size_t>(height);
  inverse_depth.assign(pixels, 0.0F);
  drawn.resize(pixels);
  triangles.clear();

  constexpr int kLanes = 8;
  blocks.across = (width + kBlock - 1) / kBlock;
  tiles.across = blocks.across * (kBlock / kTile);
  const int down = (height + kBlock - 1) / kBlock;
  blocks.least.assign(blocks.Of(0, down * kBlock) + kLanes, 0.0F);
  // Tiles beside the picture hide nothing of their block.
  tiles.least.assign(tiles.Of(0, down * kBlock) + kLanes, kHighest);
  for (int v = 0; v < height; v += kTile)
    for (int u = 0; u < width; u += kTile) tiles.least[tiles.Of(u, v)] = 0;
  is_stale.assign(tiles.least.size(), 0);
}

}  // namespace crossnav::sim
