// SPDX-License-Identifier: MIT
// End voxels of one image row, vectorised (Highway, chosen at run time). In double; where a voxel
// face is so near that the order of operations could decide, the pixel is named for the literal
// formula (back_projection.h), so that every instruction set gives the same voxels. Internal.
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

/// Where a pixel says nothing or ends nowhere, x is this.
inline constexpr std::int32_t kNoEnd = std::numeric_limits<std::int32_t>::min();

struct RowEnds {
  std::vector<std::int32_t> x, y, z;  ///< voxels; see kNoEnd
  std::vector<std::int32_t> special;  ///< pixels to be computed literally, or beyond depth_max
  std::vector<std::int32_t> starts;   ///< first pixel of each run of equal voxels
  int special_count = 0, start_count = 0;
  std::unique_ptr<RowEnds> rest;  ///< room for a row's last few pixels

  void Resize(int width);
};

/// Pixels of a row, from `first` up to `end`, which is none of them.
struct RowSpan {
  int first = 0, end = 0;
};

/// Fills x, y, z, special and `reach_m` (see DepthView) of a row's pixels.
void ComputeRow(const float* depth_m, RowSpan pixels, const RowRays& rays, RowEnds* ends,
                float* reach_m);

/// Fills `starts` from x, y, z.
void FindRuns(int width, RowEnds* ends);

/// Those pixels u of `row` whose voxel and that of u + shift in `next` share no face, or one of
/// which is missing (maybe both are), into `out`, which has room for all. Returns how many.
int FindApart(RowSpan pixels, const RowEnds& row, const RowEnds& next, int shift,
              std::int32_t* out);

}  // namespace crossnav::geometry
