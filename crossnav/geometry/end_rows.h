// SPDX-License-Identifier: MIT
// End voxels of one image row, vectorised (Highway, chosen at run time). Computed in float; near a
// voxel face, where rounding could decide, again in double; if rounding could still decide, the
// pixel is left to the literal formula (back_projection.h). Every instruction set gives the same
// voxels. Internal.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace crossnav::geometry {

/// Voxel coordinates of the row: start + depth x (base + step x u), per axis.
struct RowRays {
  std::array<double, 3> start{}, base{}, step{};
  double depth_min_m = 0, depth_max_m = 0;
};

/// Value of x for a pixel without an end voxel.
inline constexpr std::int32_t kNoEnd = std::numeric_limits<std::int32_t>::min();

/// Room behind rows and lists of pixels: as many lanes as are used at most.
inline constexpr int kRowEndsPad = 16;

struct RowEnds {
  std::vector<std::int32_t> x, y, z;  ///< voxels; see kNoEnd
  std::vector<std::int32_t> special;  ///< pixels to be computed literally
  std::vector<std::int32_t> starts;   ///< first pixel of each run of equal voxels
  int special_count = 0, start_count = 0;
  int first_beyond = 0, last_beyond = -1;  ///< pixels that see farther than depth_max
  std::unique_ptr<RowEnds> rest;           ///< room for a row's last few pixels

  void Resize(int width);
};

/// Pixels of a row, from `first` up to `end`, which is none of them.
struct RowSpan {
  int first = 0, end = 0;
};

/// Fills x, y, z, special, the pixels beyond and `reach_m` (see DepthView) of a row's pixels.
void ComputeRow(const float* depth_m, RowSpan pixels, const RowRays& rays, RowEnds* ends,
                float* reach_m);

/// Fills `starts` from x, y, z.
void FindRuns(int width, RowEnds* ends);

/// Pixels of a row, 64 at most: `first` + i for every bit i.
struct PixelWord {
  int first = 0;
  std::uint64_t bits = 0;
};

/// Selects from `pixels` where the voxel in `row` and the voxel `shift` pixels further in `next`
/// share no face, or are missing. Writes to `out`, with room for 64 + kRowEndsPad; returns the
/// count.
int FindApart(const PixelWord& pixels, const RowEnds& row, const RowEnds& next, int shift,
              std::int32_t* out);

/// Selects from `pixels` where the pixel or its right or lower neighbour reaches at most
/// `farthest_m`. Reads up to 64 and kRowEndsPad floats of both rows from `pixels.first` on.
std::uint64_t FindNear(const PixelWord& pixels, const float* reach_m, const float* below_m,
                       float farthest_m);

}  // namespace crossnav::geometry
