// SPDX-License-Identifier: MIT
// Perception without networks, for tests: a suite whose parts are functions given by the test. An
// empty function sees nothing.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "crossnav/perception/perception.h"

namespace crossnav::test {

struct FakeSight {
  std::function<std::vector<perception::Detection>(const Observation&, std::string_view)> detect;
  std::function<void(const Observation&, perception::Detection&)> segment;
  std::function<Image<float>(const Observation&)> stairs;
  std::function<perception::FeatureGrid(const Observation&)> features;
  std::function<std::vector<float>(std::string_view)> text;
  std::string failing;  ///< detector | segmenter | stairs | encoder: that part reports an error
};

namespace fake {

inline tl::unexpected<Error> Broken(const std::string& part) {
  return Fail(ErrorCode::kMalformed, "the fake was told to fail", part);
}

class FakeDetector : public perception::Detector {
 public:
  explicit FakeDetector(std::shared_ptr<const FakeSight> sight) : sight_(std::move(sight)) {}
  Result<std::vector<perception::Detection>> Detect(const Observation& obs,
                                                    std::string_view goal) override {
    if (sight_->failing == "detector") return Broken("detector");
    return sight_->detect ? sight_->detect(obs, goal) : std::vector<perception::Detection>{};
  }

 private:
  std::shared_ptr<const FakeSight> sight_;
};

class FakeSegmenter : public perception::Segmenter {
 public:
  explicit FakeSegmenter(std::shared_ptr<const FakeSight> sight) : sight_(std::move(sight)) {}
  Result<void> Segment(const Observation& obs, perception::Detection& detection) override {
    if (sight_->failing == "segmenter") return Broken("segmenter");
    if (sight_->segment) sight_->segment(obs, detection);
    return {};
  }

 private:
  std::shared_ptr<const FakeSight> sight_;
};

class FakeStairs : public perception::StairSegmenter {
 public:
  explicit FakeStairs(std::shared_ptr<const FakeSight> sight) : sight_(std::move(sight)) {}
  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    if (sight_->failing == "stairs") return Broken("stairs");
    if (sight_->stairs) return sight_->stairs(obs);
    return Image<float>(obs.rgb.width, obs.rgb.height, 0.0F);
  }

 private:
  std::shared_ptr<const FakeSight> sight_;
};

class FakeEncoder : public perception::DenseEncoder {
 public:
  explicit FakeEncoder(std::shared_ptr<const FakeSight> sight) : sight_(std::move(sight)) {}
  int Dim() const override { return 4; }
  std::string Name() const override { return "fake"; }
  Result<perception::FeatureGrid> EncodeImage(const Observation& obs) override {
    if (sight_->failing == "encoder") return Broken("encoder");
    if (sight_->features) return sight_->features(obs);
    perception::FeatureGrid grid{2, 2, Dim(), {}};
    grid.data.assign(16, 0.5F);
    return grid;
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    if (sight_->failing == "encoder") return Broken("encoder");
    return sight_->text ? sight_->text(text) : std::vector<float>{1, 0, 0, 0};
  }

 private:
  std::shared_ptr<const FakeSight> sight_;
};

}  // namespace fake

inline perception::PerceptionSuite FakeSuite(FakeSight sight) {
  const auto shared = std::make_shared<const FakeSight>(std::move(sight));
  return {std::make_unique<fake::FakeDetector>(shared),
          std::make_unique<fake::FakeSegmenter>(shared), std::make_unique<fake::FakeStairs>(shared),
          std::make_unique<fake::FakeEncoder>(shared)};
}

}  // namespace crossnav::test
