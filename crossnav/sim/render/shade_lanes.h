// SPDX-License-Identifier: MIT
// Colours of a packet's hits, several at a time (Highway, chosen at run time). Internal.
//
// Scalar reference: shading.h, equal byte for byte (tests/sim/shade_lanes_test.cpp). For one hit at
// barycentric (s, t):
//   colour = material colour, times the bilinear texture sample at the interpolated (u, v) / 255,
//            times the interpolated corner colour / 255
//   light  = 1 for unlit materials, else 0.52 + 0.32 |n . d| / (|n| |d|)
//            + (0.10 n_z + 0.06 n_x + 0.03 n_y) / |n|, n turned towards the viewer
//   byte   = floor(colour * light + 0.5) for each channel
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

inline constexpr int kShadeLanes = 8;

/// Inputs of a triangle's colour, by its index in the scene; one cache line each.
class Skins {
 public:
  explicit Skins(const Scene& scene);

  /// Words of a triangle. Colours are packed as red, green, blue from the lowest byte.
  enum Word : int {
    kU = 0,         ///< texture coordinates of the three corners, bits of floats
    kV = 3,         ///< likewise
    kCorner = 6,    ///< colours of the three corners; white where there are none
    kBase = 9,      ///< the material's
    kTexture = 10,  ///< number, -1 without
    kWidth = 11,    ///< of the texture [px]
    kHeight = 12,
    kUnlit = 13,  ///< 1 for colours without lighting
    kWords = 16
  };

  struct alignas(64) Skin {
    std::array<std::int32_t, kWords> words{};
  };

  std::vector<Skin> triangles;
  std::vector<const Rgb8*> textures;  ///< rows of pixels
  bool has_textures = false, has_corners = false;
};

/// Hits of a packet of kShadeLanes rays; lanes without a hit may name any triangle and hold any
/// finite numbers.
struct PacketHits {
  const std::int32_t* triangle = nullptr;
  const float *s = nullptr, *t = nullptr;  ///< weights of the second and third corner
  std::array<const float*, 3> normal{}, ray{};
};

/// Colours, packed as above.
void ShadePacket(const Skins& skins, const PacketHits& hits,
                 std::span<std::uint32_t, kShadeLanes> colours);

}  // namespace crossnav::sim
