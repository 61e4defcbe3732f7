// SPDX-License-Identifier: MIT
// Detectors with labels, boxes and scores in the frame's own pixels as output: DEIM, D-FINE,
// RT-DETR from their public exporters. Inputs `images` and `orig_target_sizes` (width, height).
#include <algorithm>
#include <cmath>

#include "crossnav/inference/boxes.h"
#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/parts.h"

namespace crossnav::inference {
namespace {

class DetrModel : public Model, public std::enable_shared_from_this<DetrModel> {
 public:
  DetrModel(ModelCard card, Network network)
      : card_(std::move(card)), network_(std::move(network)) {}
  std::unique_ptr<perception::Detector> MakeDetector() override {
    return std::make_unique<DetectorOf<DetrModel>>(shared_from_this());
  }

  Result<std::vector<perception::Detection>> Detect(const Observation& obs, std::string_view goal) {
    const std::vector<int> wanted = LabelsOf(goal, card_.labels);
    if (wanted.empty()) return NoSuchLabel(goal, card_);
    const auto boxes = DetectAll(obs, card_.thresholds.score);
    if (!boxes) return tl::unexpected(boxes.error());
    std::vector<perception::Detection> out;
    for (const FoundBox& box : *boxes) {
      if (std::find(wanted.begin(), wanted.end(), box.label) == wanted.end()) continue;
      const auto pixels = Placement{}.ToFrame(box.left, box.top, box.right, box.bottom,
                                              obs.rgb.width, obs.rgb.height);
      const double confidence = ConfidenceOf(card_.thresholds, box.label, box.score);
      if (pixels.Area() > 0) out.push_back({pixels, static_cast<float>(confidence), {}, 0});
    }
    return out;
  }

  Result<std::vector<FoundBox>> DetectAll(const Observation& obs, double least) override {
    const Tensor inputs[] = {
        ColourTensor(obs.rgb, card_.input, "images"),
        {"orig_target_sizes",
         {1, 2},
         {static_cast<float>(obs.rgb.width), static_cast<float>(obs.rgb.height)}}};
    const auto outputs = network_.Run(inputs);
    if (!outputs) return tl::unexpected(outputs.error());
    const Tensor &labels = (*outputs)[0], &boxes = (*outputs)[1], &scores = (*outputs)[2];
    if (labels.data.size() != scores.data.size() || boxes.data.size() != 4 * scores.data.size())
      return Fail(ErrorCode::kMismatch, "labels, boxes and scores differ in number",
                  network_.where());
    std::vector<FoundBox> found;
    for (std::size_t i = 0; i < scores.data.size(); ++i) {
      const float* box = &boxes.data[4 * i];
      const int label = static_cast<int>(std::lround(labels.data[i]));
      if (scores.data[i] >= least)
        found.push_back({box[0], box[1], box[2], box[3], scores.data[i], label, i});
    }
    return Suppress(std::move(found), card_.thresholds.nms_iou);
  }

 private:
  ModelCard card_;
  Network network_;
};

}  // namespace

Result<std::shared_ptr<Model>> OpenDetrDetector(const ModelCard& card,
                                                const ModelOptions& options) {
  const std::int64_t top = card.output.top > 0 ? card.output.top : -1;
  const Signature signature{
      {{"images", {1, 3, card.input.height, card.input.width}}, {"orig_target_sizes", {1, 2}}},
      {{"labels", {1, top}}, {"boxes", {1, top, 4}}, {"scores", {1, top}}}};
  auto network = OpenNetwork(card, signature, options);
  if (!network) return tl::unexpected(network.error());
  return std::make_shared<DetrModel>(card, std::move(*network));
}

}  // namespace crossnav::inference
