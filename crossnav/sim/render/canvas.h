// SPDX-License-Identifier: MIT
// Canvas of the rasterizer. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crossnav::sim {

inline constexpr int kTile = 8;    ///< [px]
inline constexpr int kBlock = 64;  ///< [px]; 8 x 8 tiles

inline constexpr float kHighest = 1e6F;  ///< [1/m]; of triangles that reach behind the camera

/// The picture cut into squares of `kSide` pixels: of each, a bound on the inverse depths in it.
template <int kSide>
struct Squares {
  int across = 0;
  std::vector<float> least;  ///< [1/m]; row by row, padded so that a vector may start at any

  std::size_t Of(int u, int v) const {
    return static_cast<std::size_t>(v / kSide) * static_cast<std::size_t>(across) +
           static_cast<std::size_t>(u / kSide);
  }
};

/// A drawn triangle: 32 words, so that lanes can gather them.
struct alignas(128) Drawn {
  /// By corner: weight a u + b v + c at pixel (u, v), all three up to one factor.
  std::array<float, 9> weights{};
  std::array<float, 3> normal{};  ///< world, any length
  std::uint32_t triangle = 0;     ///< of the mesh
  std::int32_t instance = 0;
  std::array<double, 5> plane{};  ///< of SeenPlane: normal, rise, least
};

/// Which triangle every pixel shows.
struct Canvas {
  int width = 0, height = 0;         ///< [px]
  int stride = 0;                    ///< pixels from row to row, more than wide by a vector
  std::vector<float> inverse_depth;  ///< [1/m], 0 = nothing
  std::vector<std::uint32_t> drawn;  ///< index
  std::vector<Drawn> triangles;

  /// Lower bound of the inverse depth in a square. Pixels only get nearer, so that an old bound
  /// stays valid.
  Squares<kTile> tiles;
  Squares<kBlock> blocks;              ///< of tiles
  std::vector<std::uint8_t> is_stale;  ///< of each tile: drawn on since it was looked at

  void Clear(int width_px, int height_px);
};

}  // namespace crossnav::sim
