// SPDX-License-Identifier: MIT
// eq:supp_observation_quality over an image, three rows at a time.
#include <algorithm>
#include <limits>
#include <utility>

#include "crossnav/core/check.h"
#include "crossnav/memory/row_kernels.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::memory {
namespace {

// Row `v` with zero where depth is invalid, between two zeros; all zeros outside the image.
void CopyRow(const DepthImage& depth_m, int v, std::vector<float>& row) {
  if (v < 0 || v >= depth_m.height) {
    std::fill(row.begin(), row.end(), 0.0f);
    return;
  }
  const float* in = &depth_m.data[static_cast<std::size_t>(v) * depth_m.width];
  for (int u = 0; u < depth_m.width; ++u)
    row[u + 1] = in[u] > 0 && in[u] <= std::numeric_limits<float>::max() ? in[u] : 0.0f;
}

QualityFactors FactorsOf(const CameraIntrinsics& camera, const FusionConfig& config) {
  const double scale =
      config.gradient_scale > 0 ? config.gradient_scale : camera.width_px / camera.fx;
  const double sigma = config.depth_scale_m;
  return {static_cast<float>(2 * config.gamma * scale),
          static_cast<float>(config.preferred_depth_m),
          static_cast<float>(1 / (3 * sigma * sigma))};
}

}  // namespace

void ObservationQuality(const DepthImage& depth_m, const CameraIntrinsics& camera,
                        const FusionConfig& config, Image<float>& quality) {
  CROSSNAV_CHECK(camera.fx > 0 || config.gradient_scale > 0, "the camera has a focal length");
  if (quality.width != depth_m.width || quality.height != depth_m.height)
    quality = Image<float>(depth_m.width, depth_m.height);
  if (depth_m.empty()) return;
  const QualityFactors factors = FactorsOf(camera, config);
  std::vector<float> above(depth_m.width + 2, 0.0f), row = above, below = above;
  CopyRow(depth_m, 0, row);
  for (int v = 0; v < depth_m.height; ++v) {
    CopyRow(depth_m, v + 1, below);
    QualityRow({above.data(), row.data(), below.data()}, depth_m.width, factors,
               &quality.data[static_cast<std::size_t>(v) * depth_m.width]);
    std::swap(above, row);
    std::swap(row, below);
  }
}

Image<float> ObservationQuality(const DepthImage& depth_m, const CameraIntrinsics& camera,
                                const FusionConfig& config) {
  Image<float> quality;
  ObservationQuality(depth_m, camera, config, quality);
  return quality;
}

}  // namespace crossnav::memory
