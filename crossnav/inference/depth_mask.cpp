// SPDX-License-Identifier: MIT
#include "crossnav/inference/depth_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "crossnav/inference/frame_input.h"

namespace crossnav::inference {
namespace {

constexpr double kMiddle = 0.5;    // chosen: side of the part that the object certainly covers
constexpr double kGap = 0.06;      // chosen: of the depth, gap between surfaces (0.12 m at 2 m)
constexpr double kMinGap_m = 0.1;  // chosen: a voxel
constexpr double kStep = 0.03;     // chosen: of the depth, between neighbours of one surface
constexpr double kMinShare = 0.3;  // chosen: minimum share of the middle for the object's cluster
constexpr int kDepthStride = 2;    // chosen: sampling of depths
constexpr std::array<std::pair<int, int>, 4> kNeighbours = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

struct DepthRange {
  float near_m = 0, far_m = 0;
  double share = 0;  // of the depths in the middle
};

/// The nearest cluster of the middle's depths that is large enough, or else the largest cluster.
DepthRange ClusterOf(std::vector<float> depths, std::size_t places) {
  std::sort(depths.begin(), depths.end());
  DepthRange best;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= depths.size(); ++i) {
    const bool ends =
        i == depths.size() || depths[i] - depths[i - 1] > std::max(kMinGap_m, kGap * depths[i - 1]);
    if (!ends) continue;
    const DepthRange range{depths[first], depths[i - 1],
                           static_cast<double>(i - first) / static_cast<double>(places)};
    if (best.share < kMinShare && range.share > best.share) best = range;
    first = i;
  }
  return best;
}

}  // namespace

namespace {

/// Calls visit(u, v) for every `stride`th pixel of the middle of the box, in rows and columns.
template <class F>
void ForEachInMiddle(const perception::PixelBox& box, int stride, F&& visit) {
  const int inset_u = static_cast<int>((box.u1 - box.u0) * (1 - kMiddle) / 2);
  const int inset_v = static_cast<int>((box.v1 - box.v0) * (1 - kMiddle) / 2);
  for (int v = box.v0 + inset_v; v < box.v1 - inset_v; v += stride)
    for (int u = box.u0 + inset_u; u < box.u1 - inset_u; u += stride) visit(u, v);
}

}  // namespace

perception::Detection DepthMask(const DepthImage& depth_m, perception::Detection detection) {
  const perception::PixelBox box{std::clamp(detection.box.u0, 0, depth_m.width),
                                 std::clamp(detection.box.v0, 0, depth_m.height),
                                 std::clamp(detection.box.u1, 0, depth_m.width),
                                 std::clamp(detection.box.v1, 0, depth_m.height)};
  detection.mask = MaskImage(depth_m.width, depth_m.height);
  detection.mask_quality = 0;
  std::vector<float> depths;
  std::size_t places = 0;
  ForEachInMiddle(box, kDepthStride, [&](int u, int v) {
    ++places;
    if (IsMeasured(depth_m.At(u, v))) depths.push_back(depth_m.At(u, v));
  });
  if (depths.empty()) return detection;
  const DepthRange range = ClusterOf(std::move(depths), places);

  // Grows from the cluster's pixels in the middle outwards, over depth steps within a surface.
  std::vector<std::pair<int, int>> open;
  const auto add = [&](int u, int v) {
    detection.mask.At(u, v) = 1;
    open.emplace_back(u, v);
  };
  ForEachInMiddle(box, 1, [&](int u, int v) {
    const float d = depth_m.At(u, v);
    if (IsMeasured(d) && d >= range.near_m && d <= range.far_m) add(u, v);
  });
  const double slack = std::max(kMinGap_m, kGap * range.far_m);
  while (!open.empty()) {
    const auto [u, v] = open.back();
    open.pop_back();
    const float from = depth_m.At(u, v);
    for (const auto& [du, dv] : kNeighbours) {
      const int nu = u + du, nv = v + dv;
      if (nu < box.u0 || nv < box.v0 || nu >= box.u1 || nv >= box.v1) continue;
      const float d = depth_m.At(nu, nv);
      const bool is_same = IsMeasured(d) && std::abs(d - from) <= kStep * from &&
                           d >= range.near_m - slack && d <= range.far_m + slack;
      if (is_same && detection.mask.At(nu, nv) == 0) add(nu, nv);
    }
  }
  detection.mask_quality = static_cast<float>(std::min(1.0, range.share));
  return detection;
}

namespace {

class DepthSegmenter : public perception::Segmenter {
 public:
  Result<void> Segment(const Observation& obs, perception::Detection& detection) override {
    detection = DepthMask(obs.depth_m, std::move(detection));
    return {};
  }
};

}  // namespace

std::unique_ptr<perception::Segmenter> MakeDepthSegmenter() {
  return std::make_unique<DepthSegmenter>();
}

}  // namespace crossnav::inference
