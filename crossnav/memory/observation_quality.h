// SPDX-License-Identifier: MIT
// eq:supp_observation_quality, row by row: a row is used while it is in the first-level cache.
#pragma once

#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/memory/row_kernels.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::memory {

class QualityRows {
 public:
  /// `depth_m` is kept by reference.
  void Reset(const DepthImage& depth_m, const CameraIntrinsics& camera, const FusionConfig& config);

  /// Quality of the pixels of row `v`, 0 where depth is invalid; valid until the next call. Rows
  /// may be requested in any order; top to bottom is fastest.
  const float* Row(int v);

  std::size_t Bytes() const;

 private:
  const DepthImage* depth_m_ = nullptr;
  QualityFactors factors_{};
  static constexpr int kNone = -2;  // neither a row nor the row above the first
  int v_ = kNone;                   // row held by `row_`
  std::vector<float> above_, row_, below_, quality_;
};

}  // namespace crossnav::memory
