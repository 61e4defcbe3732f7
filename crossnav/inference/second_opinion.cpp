// SPDX-License-Identifier: MIT
#include "crossnav/inference/second_opinion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "crossnav/inference/depth_mask.h"
#include "crossnav/inference/frame_input.h"

namespace crossnav::inference {
namespace {

using perception::Detection;
using perception::PixelBox;

constexpr double kMostScore = 0.98;  // chosen: higher scores of the second say no more
constexpr double kSameIou = 0.4;     // chosen: overlap of boxes of one thing

double Overlap(const PixelBox& a, const FoundBox& b) {
  return inference::Overlap({static_cast<double>(a.u0), static_cast<double>(a.v0),
                             static_cast<double>(a.u1), static_cast<double>(a.v1)},
                            b);
}

bool Holds(const std::vector<int>& labels, int label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

/// The second network and its boxes of the last frame; shared by detector and segmenter.
class Second {
 public:
  Second(std::shared_ptr<Model> model, const ModelCard& card, int every)
      : model_(std::move(model)),
        labels_(card.labels),
        opinion_(card.opinion),
        every_(static_cast<std::uint64_t>(every)) {}

  /// `first`, corrected, with the boxes that only the second has.
  Result<std::vector<Detection>> Correct(const Observation& obs, std::string_view goal,
                                         std::vector<Detection> first) {
    const std::vector<int> wanted = LabelsOf(goal, labels_);
    const FrameHash hash = HashOf(obs);
    const bool is_known = seen_ == hash;
    if (!is_known) {
      seen_.reset();
      alone_.clear();
    }
    if (wanted.empty() || (!is_known && first.empty() && hash[0] % every_ != 0)) return first;
    if (!is_known) {
      auto boxes = model_->DetectAll(obs, kLeastScore);
      if (!boxes) return tl::unexpected(boxes.error());
      boxes_ = std::move(*boxes);
      seen_ = hash;
    }
    std::vector<bool> is_taken(boxes_.size(), false);
    for (Detection& detection : first) {
      const PairScores scores = ScoresAt(detection.box, boxes_, wanted);
      if (scores.best) is_taken[*scores.best] = true;
      detection.confidence = static_cast<float>(FusedConfidence(
          detection.confidence, scores.goal, scores.rival, wanted.front(), opinion_));
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const FoundBox& box = boxes_[i];
      if (is_taken[i] || !Holds(wanted, box.label) || box.score < kLeastAlone) continue;
      const PixelBox pixels = Placement{}.ToFrame(box.left, box.top, box.right, box.bottom,
                                                  obs.rgb.width, obs.rgb.height);
      if (pixels.Area() <= 0) continue;
      const double rival = ScoresAt(pixels, boxes_, wanted).rival;
      const double fused = FusedConfidence(std::nullopt, box.score, rival, box.label, opinion_);
      alone_.push_back(pixels);
      first.push_back({pixels, static_cast<float>(fused), {}, 0});
    }
    return first;
  }

  bool IsAlone(const PixelBox& box) const {
    return std::find(alone_.begin(), alone_.end(), box) != alone_.end();
  }

 private:
  std::shared_ptr<Model> model_;
  std::vector<std::string> labels_;
  ModelCard::Opinion opinion_;
  std::uint64_t every_;
  std::optional<FrameHash> seen_;  // frame of boxes_ and alone_
  std::vector<FoundBox> boxes_;
  std::vector<PixelBox> alone_;  // returned boxes that only the second has
};

class PairDetector : public perception::Detector {
 public:
  PairDetector(std::unique_ptr<Detector> first, std::shared_ptr<Second> second)
      : first_(std::move(first)), second_(std::move(second)) {}
  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) override {
    auto found = first_->Detect(obs, goal);
    if (!found) return found;
    return second_->Correct(obs, goal, std::move(*found));
  }

 private:
  std::unique_ptr<Detector> first_;
  std::shared_ptr<Second> second_;
};

class PairSegmenter : public perception::Segmenter {
 public:
  PairSegmenter(std::unique_ptr<Segmenter> first, std::shared_ptr<Second> second)
      : first_(std::move(first)), second_(std::move(second)) {}
  Result<void> Segment(const Observation& obs, Detection& detection) override {
    if (!second_->IsAlone(detection.box)) return first_->Segment(obs, detection);
    detection = DepthMask(obs.depth_m, std::move(detection));
    return {};
  }

 private:
  std::unique_ptr<Segmenter> first_;
  std::shared_ptr<Second> second_;
};

}  // namespace

double BoundedLogOdds(double score) {
  const double p = std::clamp(score, kLeastScore, kMostScore);
  return std::log(p / (1 - p));
}

PairScores ScoresAt(const PixelBox& box, const std::vector<FoundBox>& boxes,
                    const std::vector<int>& labels) {
  PairScores scores;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (Overlap(box, boxes[i]) < kSameIou) continue;
    if (!Holds(labels, boxes[i].label)) {
      scores.rival = std::max(scores.rival, boxes[i].score);
    } else if (boxes[i].score > scores.goal) {
      scores.goal = boxes[i].score;
      scores.best = i;
    }
  }
  return scores;
}

double FusedConfidence(std::optional<double> first, double second, double rival, int label,
                       const ModelCard::Opinion& opinion) {
  const double own =
      first ? BoundedLogOdds(*first) : opinion.unseen_of.at(static_cast<std::size_t>(label));
  const double sum = own +
                     opinion.weight.value_or(0) * (BoundedLogOdds(second) - BoundedLogOdds(rival)) +
                     opinion.neutral;
  return 1 / (1 + std::exp(-sum));
}

DetectorPair MakeDetectorPair(std::unique_ptr<perception::Detector> first,
                              std::unique_ptr<perception::Segmenter> segmenter,
                              std::shared_ptr<Model> second, const ModelCard& card, int every) {
  auto shared = std::make_shared<Second>(std::move(second), card, every);
  return {std::make_unique<PairDetector>(std::move(first), shared),
          std::make_unique<PairSegmenter>(std::move(segmenter), shared)};
}

}  // namespace crossnav::inference
