// SPDX-License-Identifier: MIT
// The YOLO family, in the layout of public exporters: input `images`; YOLOv8 and later `output0`
// and, for segmentation, `output1` with the prototypes of masks; YOLOv7 and YOLOX `output`.
// YOLO-World can take the vectors of its words as a second input, `texts`.
#include <algorithm>
#include <cmath>
#include <optional>

#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/parts.h"
#include "crossnav/inference/vocabulary.h"
#include "crossnav/inference/yolo_boxes.h"

namespace crossnav::inference {
namespace {

using perception::Detection;
using perception::PixelBox;

enum class Kind { kYolo8, kYolo8Segment, kYoloWorld, kYolo7, kYolo7EndToEnd, kYoloX };

class YoloModel : public Model, public std::enable_shared_from_this<YoloModel> {
 public:
  YoloModel(Kind kind, ModelCard card, Network network, std::optional<Vocabulary> words)
      : kind_(kind),
        card_(std::move(card)),
        network_(std::move(network)),
        words_(std::move(words)) {}
  std::unique_ptr<perception::Detector> MakeDetector() override {
    return std::make_unique<DetectorOf<YoloModel>>(shared_from_this());
  }
  std::unique_ptr<perception::Segmenter> MakeSegmenter() override {
    if (kind_ != Kind::kYolo8Segment) return nullptr;
    return std::make_unique<SegmenterOf<YoloModel>>(shared_from_this());
  }

  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) {
    Wanted wanted{LabelsOf(goal, card_.labels), card_.thresholds.score};
    std::vector<Tensor> inputs;
    if (words_) {
      auto texts = words_->With(goal, wanted.labels);
      if (!texts) return tl::unexpected(texts.error());
      inputs.push_back(std::move(*texts));
    }
    if (wanted.labels.empty()) return NoSuchLabel(goal, card_);
    inputs.insert(inputs.begin(), ColourTensor(obs.rgb, card_.input, "images"));
    auto outputs = network_.Run(inputs);
    if (!outputs) return tl::unexpected(outputs.error());
    outputs_ = std::move(*outputs);
    found_.clear();
    placement_ = PlacementOf(card_.input, obs.rgb.width, obs.rgb.height);
    std::vector<Detection> out;
    for (const FoundBox& box : Suppress(Boxes(wanted), card_.thresholds.nms_iou)) {
      const PixelBox pixels = placement_.ToFrame(box.left, box.top, box.right, box.bottom,
                                                 obs.rgb.width, obs.rgb.height);
      if (pixels.Area() <= 0) continue;
      const double confidence = ConfidenceOf(card_.thresholds, box.label, box.score);
      out.push_back({pixels, static_cast<float>(confidence), {}, 0});
      found_.push_back({pixels, box.index});
    }
    return out;
  }

  /// For boxes of the last Detect only: the prototypes of masks belong to that frame.
  Result<void> Segment(const Observation& obs, Detection& detection) const {
    const auto known = std::find_if(found_.begin(), found_.end(), [&](const Found& f) {
      const PixelBox &a = f.box, &b = detection.box;
      return a.u0 == b.u0 && a.v0 == b.v0 && a.u1 == b.u1 && a.v1 == b.v1;
    });
    if (known == found_.end())
      return Fail(ErrorCode::kMismatch,
                  "gives masks of its own boxes only; networks.segmenter = depth does for others",
                  card_.path.string());
    const Tensor &boxes = outputs_[0], &prototypes = outputs_[1];
    const auto count = static_cast<std::size_t>(boxes.shape[2]);
    const int rows = static_cast<int>(prototypes.shape[2]);
    const int cols = static_cast<int>(prototypes.shape[3]);
    const std::size_t plane = static_cast<std::size_t>(rows) * cols;
    std::vector<float> logit(plane, 0.0F);
    for (std::int64_t k = 0; k < prototypes.shape[1]; ++k) {
      const std::size_t row = 4 + static_cast<std::size_t>(card_.output.classes + k);
      const float weight = boxes.data[row * count + known->index];
      const float* from = &prototypes.data[static_cast<std::size_t>(k) * plane];
      for (std::size_t i = 0; i < plane; ++i) logit[i] += weight * from[i];
    }
    const Image<float> large = ToFrameSize(logit.data(), rows, cols, placement_, card_.input,
                                           obs.rgb.width, obs.rgb.height, detection.box);
    Fill(large, detection);
    return {};
  }

 private:
  struct Found {
    PixelBox box;
    std::size_t index;
  };

  std::vector<FoundBox> Boxes(const Wanted& wanted) const {
    const Tensor& output = outputs_[0];
    switch (kind_) {
      case Kind::kYolo8:
      case Kind::kYolo8Segment:
        return BoxesOfYolo8(output, card_.output.classes, wanted);
      case Kind::kYoloWorld: {  // remaining places repeat a word: they are no classes
        const int labels = static_cast<int>(card_.labels.size());
        return BoxesOfYolo8(output, std::max(labels, wanted.labels.back() + 1), wanted);
      }
      case Kind::kYolo7:
        return BoxesOfYolo7(output, card_.output.classes, wanted);
      case Kind::kYolo7EndToEnd:
        return BoxesOfEndToEnd(output, wanted);
      case Kind::kYoloX:
        break;
    }
    return BoxesOfYoloX(output, card_.output.classes, card_.input.width, card_.input.height,
                        wanted);
  }

  void Fill(const Image<float>& logit, Detection& detection) const {
    detection.mask = MaskImage(logit.width, logit.height);
    double inside = 0, sum = 0;
    const PixelBox& box = detection.box;
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) {
        const double p = 1 / (1 + std::exp(-static_cast<double>(logit.At(u, v))));
        if (p < card_.thresholds.mask) continue;
        detection.mask.At(u, v) = 1;
        inside += 1;
        sum += p;
      }
    detection.mask_quality = inside > 0 ? static_cast<float>(sum / inside) : 0.0F;
  }

  Kind kind_;
  ModelCard card_;
  Network network_;
  std::optional<Vocabulary> words_;  // of YOLO-World
  std::vector<Tensor> outputs_;      // of the last frame of Detect
  std::vector<Found> found_;
  Placement placement_;
};

Signature SignatureOf(Kind kind, const ModelCard& card) {
  const std::int64_t height = card.input.height, width = card.input.width;
  const std::int64_t classes = card.output.classes;
  const Port images{"images", {1, 3, height, width}};
  switch (kind) {
    case Kind::kYolo8:
      return {{images}, {{"output0", {1, 4 + classes, -1}}}};
    case Kind::kYolo8Segment:
      return {{images},
              {{"output0", {1, 4 + classes + card.output.dim, -1}},
               {"output1", {1, card.output.dim, -1, -1}}}};
    case Kind::kYoloWorld:
      return {{images, {"texts", {1, classes, card.output.dim}}},
              {{"output0", {1, 4 + classes, -1}}}};
    case Kind::kYolo7:
      return {{images}, {{"output", {1, -1, 5 + classes}}}};
    case Kind::kYolo7EndToEnd:
      return {{images}, {{"output", {-1, 7}}}};
    case Kind::kYoloX:
      break;
  }
  return {{images},
          {{"output", {1, CellsOfYoloX(card.input.width, card.input.height), 5 + classes}}}};
}

Result<std::shared_ptr<Model>> OpenYolo(Kind kind, const ModelCard& card,
                                        const ModelOptions& options) {
  const auto bad = [&](const char* what) {
    return Fail(ErrorCode::kInvalid, what, card.path.string());
  };
  std::optional<Vocabulary> words;
  if (kind == Kind::kYoloWorld) {
    auto opened = Vocabulary::Open(card, options);
    if (!opened) return tl::unexpected(opened.error());
    words = std::move(*opened);
  } else if (card.labels.empty()) {
    return bad("key \"labels\" is missing");
  }
  if (card.input.layout != "chw") return bad("key \"input.layout\" must be chw");
  if (kind == Kind::kYolo8Segment && card.output.dim < 1)
    return bad("key \"output.dim\", the number of mask prototypes, is missing");
  auto network = OpenNetwork(card, SignatureOf(kind, card), options);
  if (!network) return tl::unexpected(network.error());
  return std::make_shared<YoloModel>(kind, card, std::move(*network), std::move(words));
}

}  // namespace

Result<std::shared_ptr<Model>> OpenYolo8(const ModelCard& card, const ModelOptions& options) {
  return OpenYolo(Kind::kYolo8, card, options);
}
Result<std::shared_ptr<Model>> OpenYolo8Segment(const ModelCard& card,
                                                const ModelOptions& options) {
  return OpenYolo(Kind::kYolo8Segment, card, options);
}
Result<std::shared_ptr<Model>> OpenYoloWorld(const ModelCard& card, const ModelOptions& options) {
  return OpenYolo(Kind::kYoloWorld, card, options);
}
Result<std::shared_ptr<Model>> OpenYolo7(const ModelCard& card, const ModelOptions& options) {
  return OpenYolo(Kind::kYolo7, card, options);
}
Result<std::shared_ptr<Model>> OpenYolo7EndToEnd(const ModelCard& card,
                                                 const ModelOptions& options) {
  return OpenYolo(Kind::kYolo7EndToEnd, card, options);
}
Result<std::shared_ptr<Model>> OpenYoloX(const ModelCard& card, const ModelOptions& options) {
  return OpenYolo(Kind::kYoloX, card, options);
}

}  // namespace crossnav::inference
