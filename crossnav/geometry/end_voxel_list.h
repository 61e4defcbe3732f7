// SPDX-License-Identifier: MIT
// The end voxel of every valid depth pixel within the depth limits, row by row: how features and
// masks of an image get to voxels. Held as runs of neighbouring pixels that end in the same voxel;
// the list pixel by pixel, sixteen times as long, is made when it is first asked for. Belongs to
// the map that made it and to the thread that writes that map; valid until the next frame.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::geometry {

/// A valid depth pixel's end point: which pixel, which voxel.
struct PixelVoxel {
  std::int32_t pixel = 0;  ///< v * width + u
  VoxelKey key;
};

/// `count` pixels of one row, from `pixel` on, that end in the same voxel.
struct EndRun {
  std::int32_t pixel = 0;
  std::int32_t count = 0;
  VoxelKey key;
};

/// The runs of a list in the order of pixels, in an image of `width`.
inline std::vector<EndRun> RunsOf(const std::vector<PixelVoxel>& pixels, int width) {
  std::vector<EndRun> runs;
  for (const PixelVoxel& p : pixels) {
    const bool goes_on = !runs.empty() && runs.back().key == p.key &&
                         runs.back().pixel + runs.back().count == p.pixel && p.pixel % width != 0;
    if (goes_on)
      ++runs.back().count;
    else
      runs.push_back({p.pixel, 1, p.key});
  }
  return runs;
}

class EndVoxels {
 public:
  const std::vector<EndRun>& runs() const { return runs_; }
  std::vector<EndRun>* runs() { return &runs_; }

  /// Pixel by pixel. Cost O(pixels) the first time in a frame.
  const std::vector<PixelVoxel>& pixels() const {
    if (is_listed_) return pixels_;
    pixels_.clear();
    for (const EndRun& run : runs_)
      for (std::int32_t i = 0; i < run.count; ++i) pixels_.push_back({run.pixel + i, run.key});
    is_listed_ = true;
    return pixels_;
  }
  operator const std::vector<PixelVoxel>&() const { return pixels(); }  // NOLINT: a list to callers
  auto begin() const { return pixels().begin(); }
  auto end() const { return pixels().end(); }
  std::size_t size() const { return pixels().size(); }
  const PixelVoxel& operator[](std::size_t i) const { return pixels()[i]; }
  bool empty() const { return runs_.empty(); }

  void Clear() {
    runs_.clear();
    is_listed_ = false;
  }
  std::size_t Bytes() const {
    return runs_.capacity() * sizeof(EndRun) + pixels_.capacity() * sizeof(PixelVoxel);
  }

 private:
  std::vector<EndRun> runs_;
  mutable std::vector<PixelVoxel> pixels_;
  mutable bool is_listed_ = false;
};

}  // namespace crossnav::geometry
