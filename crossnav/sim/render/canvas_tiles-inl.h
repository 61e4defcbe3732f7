// SPDX-License-Identifier: MIT
// Occlusion by the tiles and blocks of a canvas. Per target, as Highway has it: to be included
// after highway.h by files that are compiled once per instruction set. Internal.
#if defined(CROSSNAV_SIM_CANVAS_TILES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CROSSNAV_SIM_CANVAS_TILES_INL_H_
#undef CROSSNAV_SIM_CANVAS_TILES_INL_H_
#else
#define CROSSNAV_SIM_CANVAS_TILES_INL_H_
#endif

#include <algorithm>
#include <cstddef>

#include "crossnav/sim/render/canvas.h"
#include "crossnav/sim/render/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {

struct PixelBox {
  int u0, u1, v0, v1;  // inclusive
};

// Of the pixels of row `v` of a tile.
HWY_INLINE V LeastOfTileRow(const Canvas& canvas, int u0, int v) {
  const Wide d;
  const float* row = canvas.inverse_depth.data() +
                     static_cast<std::size_t>(v) * static_cast<std::size_t>(canvas.stride) + u0;
  V least = hn::LoadU(d, row);
  for (std::size_t i = hn::Lanes(d); i < kTile; i += hn::Lanes(d))
    least = hn::Min(least, hn::LoadU(d, row + i));
  return least;
}

HWY_INLINE void NoteTile(Canvas& canvas, std::size_t tile, V least) {
  canvas.tiles.least[tile] = hn::GetLane(hn::MinOfLanes(Wide(), least));
  canvas.is_stale[tile] = 0;
}

HWY_INLINE void NoteBlock(Canvas& canvas, int u0, int v0) {
  const Wide d;
  V least = hn::Set(d, kHighest);
  for (int v = v0; v < v0 + kBlock; v += kTile)
    for (int u = u0; u < u0 + kBlock; u += kTile * static_cast<int>(hn::MaxLanes(d)))
      least = hn::Min(least, hn::LoadU(d, &canvas.tiles.least[canvas.tiles.Of(u, v)]));
  canvas.blocks.least[canvas.blocks.Of(u0, v0)] = hn::GetLane(hn::MinOfLanes(d, least));
}

// Whether the pixels of the tile at (`u0`, `v0`) in the box are all nearer than `nearest`; used if
// the tile's bound cannot tell.
HWY_INLINE bool IsTileNearer(Canvas& canvas, int u0, int v0, const PixelBox& box, float nearest) {
  const std::size_t tile = canvas.tiles.Of(u0, v0);
  const int end = std::min(v0 + kTile, canvas.height);
  if (canvas.is_stale[tile] != 0) {
    V least = LeastOfTileRow(canvas, u0, v0);
    for (int v = v0 + 1; v < end; ++v) least = hn::Min(least, LeastOfTileRow(canvas, u0, v));
    NoteTile(canvas, tile, least);
    if (canvas.tiles.least[tile] >= nearest) return true;
  }
  for (int v = std::max(v0, box.v0); v < std::min(end, box.v1 + 1); ++v) {
    const float* row = canvas.inverse_depth.data() +
                       static_cast<std::size_t>(v) * static_cast<std::size_t>(canvas.stride);
    for (int u = std::max(u0, box.u0); u <= std::min(u0 + kTile - 1, box.u1); ++u)
      if (row[u] < nearest) return false;
  }
  return true;
}

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // CROSSNAV_SIM_CANVAS_TILES_INL_H_
