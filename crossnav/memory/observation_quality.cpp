// SPDX-License-Identifier: MIT
#include "crossnav/memory/observation_quality.h"

#include <algorithm>
#include <numbers>
#include <span>
#include <utility>

#include "crossnav/core/check.h"

namespace crossnav::memory {
namespace {

// Copies row `v` with zero for invalid depth and a zero on either side; all zeros outside the
// image.
void CopyRow(const DepthImage& depth_m, int v, std::vector<float>& row) {
  if (v < 0 || v >= depth_m.height) {
    std::fill(row.begin(), row.end(), 0.0f);
    return;
  }
  CopyValidDepth(&depth_m.data[static_cast<std::size_t>(v) * depth_m.width], depth_m.width,
                 &row[1]);
}

void PrefetchRow(const DepthImage& depth_m, int v) {
  if (v >= depth_m.height) return;
  const auto row = std::as_bytes(std::span(depth_m.data)
                                     .subspan(static_cast<std::size_t>(v) * depth_m.width)
                                     .first(static_cast<std::size_t>(depth_m.width)));
  PrefetchBytes(row.data(), row.size());
}

// Differences per pixel shrink as 1 / width; width / fx depends on the field of view alone.
double DefaultGradientScale(const CameraIntrinsics& camera) {
  constexpr double kPaperWidth_px = 640;
  const double width_px = camera.width_px;
  return width_px * width_px / (kPaperWidth_px * camera.fx);
}

QualityFactors FactorsOf(const CameraIntrinsics& camera, const FusionConfig& config) {
  const double scale =
      config.gradient_scale > 0 ? config.gradient_scale : DefaultGradientScale(camera);
  const double sigma = config.depth_scale_m;
  return {static_cast<float>(2 * config.gamma * scale * std::numbers::log2e),
          static_cast<float>(config.preferred_depth_m),
          static_cast<float>(std::numbers::log2e / (3 * sigma * sigma))};
}

}  // namespace

void QualityRows::Reset(const DepthImage& depth_m, const CameraIntrinsics& camera,
                        const FusionConfig& config) {
  CROSSNAV_CHECK(camera.fx > 0 || config.gradient_scale > 0, "the camera has a focal length");
  depth_m_ = &depth_m;
  factors_ = FactorsOf(camera, config);
  v_ = kNone;
  const auto width = static_cast<std::size_t>(depth_m.width);
  for (auto* row : {&above_, &row_, &below_}) row->assign(width + 2, 0.0F);
  quality_.resize(width);
}

const float* QualityRows::Row(int v) {
  if (v == v_ + 1) {
    std::swap(above_, row_);
    std::swap(row_, below_);
  } else {
    CopyRow(*depth_m_, v - 1, above_);
    CopyRow(*depth_m_, v, row_);
  }
  CopyRow(*depth_m_, v + 1, below_);
  PrefetchRow(*depth_m_, v + 2);
  v_ = v;
  QualityRow({above_.data(), row_.data(), below_.data()}, depth_m_->width, factors_,
             quality_.data());
  return quality_.data();
}

std::size_t QualityRows::Bytes() const {
  return (above_.capacity() + row_.capacity() + below_.capacity() + quality_.capacity()) *
         sizeof(float);
}

Image<float> ObservationQuality(const DepthImage& depth_m, const CameraIntrinsics& camera,
                                const FusionConfig& config) {
  Image<float> quality(depth_m.width, depth_m.height);
  QualityRows rows;
  rows.Reset(depth_m, camera, config);
  for (int v = 0; v < depth_m.height; ++v)
    std::copy_n(rows.Row(v), depth_m.width,
                &quality.data[static_cast<std::size_t>(v) * depth_m.width]);
  return quality;
}

}  // namespace crossnav::memory
