// SPDX-License-Identifier: MIT
#include "crossnav/serve/blind.h"

namespace crossnav::serve {
namespace {

class BlindDetector : public perception::Detector {
 public:
  Result<std::vector<perception::Detection>> Detect(const Observation& /*obs*/,
                                                    std::string_view /*goal*/) override {
    return std::vector<perception::Detection>{};
  }
};

class BlindSegmenter : public perception::Segmenter {
 public:
  Result<void> Segment(const Observation& /*obs*/, perception::Detection& /*detection*/) override {
    return {};
  }
};

class BlindStairs : public perception::StairSegmenter {
 public:
  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    return Image<float>(obs.depth_m.width, obs.depth_m.height, 0.0F);
  }
};

/// Two dimensions: all texts point along one axis, all images along the other.
class BlindEncoder : public perception::DenseEncoder {
 public:
  int Dim() const override { return 2; }
  std::string Name() const override { return "none"; }
  Result<perception::FeatureGrid> EncodeImage(const Observation& /*obs*/) override {
    return perception::FeatureGrid{1, 1, Dim(), {0.0F, 1.0F}};
  }
  Result<std::vector<float>> EncodeText(std::string_view /*text*/) override {
    return std::vector<float>{1.0F, 0.0F};
  }
};

}  // namespace

perception::PerceptionSuite BlindPerception() {
  return {std::make_unique<BlindDetector>(), std::make_unique<BlindSegmenter>(),
          std::make_unique<BlindStairs>(), std::make_unique<BlindEncoder>()};
}

}  // namespace crossnav::serve
