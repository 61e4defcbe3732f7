// SPDX-License-Identifier: MIT
// Networks with grids as output: SegFormer and similar (`pixel_values` -> `logits`), with stairs as
// the sum of some classes; and dense image features (`image` -> `features`) in either layout.
#include <algorithm>
#include <cmath>

#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/parts.h"
#include "crossnav/inference/text_source.h"

namespace crossnav::inference {
namespace {

/// For each cell, the softmax's sum over `chosen` of `classes` planes of logits.
std::vector<float> ShareOf(const Tensor& logits, const std::vector<int>& chosen) {
  const auto classes = static_cast<std::size_t>(logits.shape[1]);
  const std::size_t plane = logits.data.size() / classes;
  std::vector<float> out(plane);
  for (std::size_t i = 0; i < plane; ++i) {
    float most = logits.data[i];
    for (std::size_t c = 1; c < classes; ++c) most = std::max(most, logits.data[c * plane + i]);
    double all = 0, wanted = 0;
    for (std::size_t c = 0; c < classes; ++c) all += std::exp(logits.data[c * plane + i] - most);
    for (const int c : chosen)
      wanted += std::exp(logits.data[static_cast<std::size_t>(c) * plane + i] - most);
    out[i] = static_cast<float>(wanted / all);
  }
  return out;
}

class StairModel : public Model, public std::enable_shared_from_this<StairModel> {
 public:
  StairModel(ModelCard card, Network network)
      : card_(std::move(card)), network_(std::move(network)) {}
  std::unique_ptr<perception::StairSegmenter> MakeStairs() override {
    return std::make_unique<StairsOf<StairModel>>(shared_from_this());
  }

  Result<Image<float>> SegmentStairs(const Observation& obs) {
    const Tensor input = ColourTensor(obs.rgb, card_.input, "pixel_values");
    const auto outputs = network_.Run({&input, 1});
    if (!outputs) return tl::unexpected(outputs.error());
    const Tensor& logits = outputs->front();
    std::vector<float> share = ShareOf(logits, card_.output.stair_classes);
    ScaleStairs(card_.thresholds, share);
    return ToFrameSize(share.data(), static_cast<int>(logits.shape[2]),
                       static_cast<int>(logits.shape[3]),
                       PlacementOf(card_.input, obs.rgb.width, obs.rgb.height), card_.input,
                       obs.rgb.width, obs.rgb.height);
  }

 private:
  ModelCard card_;
  Network network_;
};

class DenseModel : public Model, public std::enable_shared_from_this<DenseModel> {
 public:
  DenseModel(ModelCard card, Network network, TextSource texts)
      : card_(std::move(card)), network_(std::move(network)), texts_(std::move(texts)) {}
  std::unique_ptr<perception::DenseEncoder> MakeEncoder() override {
    return std::make_unique<EncoderOf<DenseModel>>(shared_from_this());
  }

  const ModelCard& card() const { return card_; }
  int Dim() const { return card_.output.dim; }

  Result<std::vector<float>> EncodeText(std::string_view text) { return texts_.Of(text); }

  Result<perception::FeatureGrid> EncodeImage(const Observation& obs) {
    const Tensor input = ColourTensor(obs.rgb, card_.input, "image");
    auto outputs = network_.Run({&input, 1});
    if (!outputs) return tl::unexpected(outputs.error());
    const auto& o = card_.output;
    std::vector<float>& from = outputs->front().data;
    perception::FeatureGrid grid{o.rows, o.cols, o.dim, {}};
    if (o.layout == "hwc") {
      grid.data = std::move(from);
      return grid;
    }
    const std::size_t cells = static_cast<std::size_t>(o.rows) * o.cols;
    const auto dim = static_cast<std::size_t>(o.dim);
    grid.data.resize(from.size());
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t i = 0; i < cells; ++i) grid.data[i * dim + c] = from[c * cells + i];
    return grid;
  }

 private:
  ModelCard card_;
  Network network_;
  TextSource texts_;
};

Shape ImageShape(const ModelCard::Input& input) {
  if (input.layout == "hwc") return {1, input.height, input.width, 3};
  return {1, 3, input.height, input.width};
}

}  // namespace

Result<std::shared_ptr<Model>> OpenSegFormer(const ModelCard& card, const ModelOptions& options) {
  const auto& o = card.output;
  if (o.classes < 1 || o.stair_classes.empty())
    return Fail(ErrorCode::kInvalid, "keys \"output.classes\" and stair_classes are missing",
                card.path.string());
  if (*std::max_element(o.stair_classes.begin(), o.stair_classes.end()) >= o.classes)
    return Fail(ErrorCode::kInvalid, "key \"output.stair_classes\" names a class that there is not",
                card.path.string());
  auto network = OpenNetwork(
      card, {{{"pixel_values", ImageShape(card.input)}}, {{"logits", {1, o.classes, -1, -1}}}},
      options);
  if (!network) return tl::unexpected(network.error());
  return std::make_shared<StairModel>(card, std::move(*network));
}

Result<std::shared_ptr<Model>> OpenDense(const ModelCard& card, const ModelOptions& options) {
  const auto& o = card.output;
  if (o.rows < 1 || o.cols < 1 || o.dim < 1)
    return Fail(ErrorCode::kInvalid, "keys \"output.rows\", cols and dim are missing",
                card.path.string());
  if (card.input.resize != "plain")
    return Fail(ErrorCode::kInvalid, "key \"input.resize\" must be plain: cells cover the picture",
                card.path.string());
  const Shape shape =
      o.layout == "hwc" ? Shape{1, o.rows, o.cols, o.dim} : Shape{1, o.dim, o.rows, o.cols};
  auto network =
      OpenNetwork(card, {{{"image", ImageShape(card.input)}}, {{"features", shape}}}, options);
  if (!network) return tl::unexpected(network.error());
  auto texts = TextSource::Open(card, o.dim, options);
  if (!texts) return tl::unexpected(texts.error());
  return std::make_shared<DenseModel>(card, std::move(*network), std::move(*texts));
}

}  // namespace crossnav::inference
