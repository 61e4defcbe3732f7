// SPDX-License-Identifier: MIT
#include "crossnav/inference/detector_by_goal.h"

#include <utility>

namespace crossnav::inference {
namespace {

using perception::Detection;
using perception::Detector;

class DetectorByGoal : public Detector {
 public:
  explicit DetectorByGoal(std::vector<std::unique_ptr<Detector>> detectors)
      : detectors_(std::move(detectors)) {}

  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) override {
    for (std::size_t i = 0; i + 1 < detectors_.size(); ++i) {
      auto found = detectors_[i]->Detect(obs, goal);
      if (found || found.error().code != ErrorCode::kUnsupported) return found;
    }
    return detectors_.back()->Detect(obs, goal);
  }

 private:
  std::vector<std::unique_ptr<Detector>> detectors_;
};

}  // namespace

std::unique_ptr<Detector> MakeDetectorByGoal(std::vector<std::unique_ptr<Detector>> detectors) {
  if (detectors.empty()) return nullptr;
  if (detectors.size() == 1) return std::move(detectors.front());
  return std::make_unique<DetectorByGoal>(std::move(detectors));
}

}  // namespace crossnav::inference
