// SPDX-License-Identifier: MIT
// Inner loops of grazing_surface.h, vectorised with Highway, chosen at run time. Internal.
//
// Scalar code for one gap, with inverse depths i(k) of the pixels k = -2..3 on its line; the gap is
// between pixels 0 and 1:
//   FindSegments: if the gap is not wide, or i(1) - i(0) equals the step on either side within half
//     of it, the segment from pixel 0 to pixel 1. Else, for each side whose last two steps agree
//     and recede, the segment from its pixel along that slope, to the other pixel or to the depth
//     limit, unless the other pixel lies behind the extended plane.
//   WalkSegments: WalkRay along each segment; keeps the voxels that may be in `wanted`.
// References: LiteralSegments (tests/geometry/grazing_surface_simd_test.cpp), BackProjectToVoxels
// and WalkRay. Double precision in the same order of operations: every instruction set gives the
// same voxels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crossnav/geometry/integrate.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

/// A batch of gaps: neighbouring pixels with end voxels that share no face. Pixel (u, v) and its
/// right or lower neighbour.
struct Gaps {
  static constexpr int kRoom = 256;  // chosen: with their segments in the first cache
  std::array<std::int32_t, kRoom> u{}, v{};
  std::array<std::int32_t, kRoom> is_column{};  ///< 1: the other pixel is below
  std::array<std::int32_t, kRoom> is_wide{};    ///< 1: their voxels do not even touch
  int count = 0;

  void Add(int at_u, int at_v, bool column, bool wide) {
    u[count] = at_u;
    v[count] = at_v;
    is_column[count] = column ? 1 : 0;
    is_wide[count++] = wide ? 1 : 0;
  }
};

/// From `a` to `b`, per axis [voxels].
struct Segments {
  static constexpr int kRoom = 2 * Gaps::kRoom + 16;  // two in a gap, and lanes beyond
  std::array<std::array<double, kRoom>, 3> a{}, b{};
  int count = 0;
};

/// Surface segments in the gaps. Inverse depth is linear over the image of a plane: where it is
/// linear, one segment joins both ends. Elsewhere the planes of both sides extend into the gap, up
/// to the next ray that ends in front of them or to the depth limit.
void FindSegments(const DepthFrame& frame, const MapConfig& config, const Gaps& gaps,
                  Segments* segments);

/// Hash set of voxels with false positives.
class VoxelHashes {
 public:
  void Insert(const VoxelKey& key) {
    const std::uint32_t hash = HashOf(key);
    words_[hash / 32] |= 1U << hash % 32;
  }
  bool Maybe(const VoxelKey& key) const {
    const std::uint32_t hash = HashOf(key);
    return (words_[hash / 32] >> hash % 32 & 1U) != 0;
  }

  static constexpr std::uint32_t kX = 73856093, kY = 19349663, kZ = 83492791;
  static constexpr std::uint32_t kBits = 1 << 16;  // chosen: in the first cache, mostly empty
  const std::uint32_t* words() const { return words_.data(); }

 private:
  static std::uint32_t HashOf(const VoxelKey& key) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(key.x) * kX ^
                                static_cast<std::uint32_t>(key.y) * kY ^
                                static_cast<std::uint32_t>(key.z) * kZ;
    return (mixed ^ mixed >> 16) % kBits;
  }
  std::array<std::uint32_t, kBits / 32> words_{};
};

/// Appends to `met` the voxels along the segments, as WalkRay visits them, that may be in `wanted`;
/// duplicates are possible. Skips segments whose endpoints overflow VoxelKey.
void WalkSegments(const Segments& segments, const VoxelHashes& wanted, std::vector<VoxelKey>* met);

}  // namespace crossnav::geometry
