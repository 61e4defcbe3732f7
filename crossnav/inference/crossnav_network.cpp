// SPDX-License-Identifier: MIT
// Our network (networks/): colour, depth and height above the foot in; goal centres, boxes, masks,
// stairs and dense features out. It runs once a frame, at the first call to any of its four parts.
// An optional second network of the card draws the mask in each requested box.
#include <algorithm>
#include <cmath>
#include <optional>

#include "crossnav/inference/boxes.h"
#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/parts.h"
#include "crossnav/inference/text_table.h"

namespace crossnav::inference {
namespace {

using perception::Detection;
using perception::PixelBox;

enum Output { kHeat, kBox, kMask, kStairs, kDense };

class CrossnavModel : public Model, public std::enable_shared_from_this<CrossnavModel> {
 public:
  CrossnavModel(ModelCard card, Network network, std::optional<Network> masks, TextTable texts,
                double camera_height_m)
      : card_(std::move(card)),
        network_(std::move(network)),
        masks_(std::move(masks)),
        texts_(std::move(texts)),
        camera_height_m_(camera_height_m) {}

  std::unique_ptr<perception::Detector> MakeDetector() override {
    return std::make_unique<DetectorOf<CrossnavModel>>(shared_from_this());
  }
  std::unique_ptr<perception::Segmenter> MakeSegmenter() override {
    return std::make_unique<SegmenterOf<CrossnavModel>>(shared_from_this());
  }
  std::unique_ptr<perception::StairSegmenter> MakeStairs() override {
    return std::make_unique<StairsOf<CrossnavModel>>(shared_from_this());
  }
  std::unique_ptr<perception::DenseEncoder> MakeEncoder() override {
    return std::make_unique<EncoderOf<CrossnavModel>>(shared_from_this());
  }

  const ModelCard& card() const { return card_; }
  int Dim() const { return texts_.dim(); }
  Result<std::vector<float>> EncodeText(std::string_view text) const { return texts_.Of(text); }

  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) {
    const std::vector<int> wanted = LabelsOf(goal, card_.labels);
    if (wanted.empty()) return NoSuchLabel(goal, card_);
    if (auto ok = See(obs); !ok) return tl::unexpected(ok.error());
    std::vector<Detection> out;
    for (const int label : wanted) AddDetections(label, obs.rgb.width, obs.rgb.height, out);
    return out;
  }

  Result<void> Segment(const Observation& obs, Detection& detection) {
    if (auto ok = See(obs); !ok) return ok;
    const int width = obs.rgb.width, height = obs.rgb.height;
    detection.mask = MaskImage(width, height);
    detection.mask_quality = 0;
    const PixelBox box{
        std::clamp(detection.box.u0, 0, width), std::clamp(detection.box.v0, 0, height),
        std::clamp(detection.box.u1, 0, width), std::clamp(detection.box.v1, 0, height)};
    if (box.u0 >= box.u1 || box.v0 >= box.v1) return {};
    const Result<Image<float>> shares =
        masks_ ? Drawn(box, width, height) : Map(kMask, LabelIn(box), width, height, box);
    if (!shares) return tl::unexpected(shares.error());
    const Image<float>& share = *shares;
    double inside = 0, sum = 0;
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) {
        const float p = share.At(u, v);
        if (p < card_.thresholds.mask) continue;
        detection.mask.At(u, v) = 1;
        inside += 1;
        sum += p;
      }
    if (inside > 0) detection.mask_quality = static_cast<float>(std::min(1.0, sum / inside));
    return {};
  }

  Result<Image<float>> SegmentStairs(const Observation& obs) {
    if (auto ok = See(obs); !ok) return tl::unexpected(ok.error());
    const int width = obs.rgb.width, height = obs.rgb.height;
    return Map(kStairs, 0, width, height, {0, 0, width, height});
  }

  Result<perception::FeatureGrid> EncodeImage(const Observation& obs) {
    if (auto ok = See(obs); !ok) return tl::unexpected(ok.error());
    const Tensor& dense = outputs_[kDense];
    return perception::FeatureGrid{static_cast<int>(dense.shape[1]),
                                   static_cast<int>(dense.shape[2]),
                                   static_cast<int>(dense.shape[3]), dense.data};
  }

 private:
  /// All outputs for this frame.
  Result<void> See(const Observation& obs) {
    const FrameHash hash = HashOf(obs);
    if (seen_ == hash) return {};
    seen_.reset();
    found_.clear();
    inputs_ = {ColourTensor(obs.rgb, card_.input, "image"), DepthTensor(obs, card_.input, "depth"),
               HeightTensor(obs, camera_height_m_, card_.input, "height")};
    auto outputs = network_.Run(inputs_);
    if (!outputs) return tl::unexpected(outputs.error());
    outputs_ = std::move(*outputs);
    ScaleStairs(card_.thresholds, outputs_[kStairs].data);
    placement_ = PlacementOf(card_.input, obs.rgb.width, obs.rgb.height);
    seen_ = hash;
    return {};
  }

  void AddDetections(int label, int width, int height, std::vector<Detection>& out) {
    for (const FoundBox& box : Suppress(Peaks(label), card_.thresholds.nms_iou)) {
      const PixelBox pixels =
          placement_.ToFrame(box.left, box.top, box.right, box.bottom, width, height);
      if (pixels.Area() <= 0) continue;
      found_.push_back({pixels, label});
      const double confidence = ConfidenceOf(card_.thresholds, box.label, box.score);
      out.push_back({pixels, static_cast<float>(confidence), {}, 0});
    }
  }

  /// Plane `channel` of an output, enlarged to the frame within `box`.
  Image<float> Map(Output output, int channel, int width, int height, const PixelBox& box) const {
    const Tensor& tensor = outputs_[output];
    const int rows = static_cast<int>(tensor.shape[2]), cols = static_cast<int>(tensor.shape[3]);
    const float* plane = &tensor.data[static_cast<std::size_t>(channel) * rows * cols];
    return ToFrameSize(plane, rows, cols, placement_, card_.input, width, height, box);
  }

  /// Output of the second network for `box`: the share of the object, by pixels of the frame within
  /// the box.
  Result<Image<float>> Drawn(const PixelBox& box, int width, int height) {
    const Tensor& mask = outputs_[kMask];
    const auto plane = static_cast<std::ptrdiff_t>(mask.shape[2] * mask.shape[3]);
    const auto share = mask.data.begin() + LabelIn(box) * plane;
    const auto x = [&](int u) { return u * placement_.scale_x + placement_.offset_x; };
    const auto y = [&](int v) { return v * placement_.scale_y + placement_.offset_y; };
    std::vector<Tensor> inputs = inputs_;
    inputs.push_back({"share", {1, 1, mask.shape[2], mask.shape[3]}, {share, share + plane}});
    inputs.push_back({"box",
                      {1, 4},
                      {static_cast<float>(x(box.u0)), static_cast<float>(y(box.v0)),
                       static_cast<float>(x(box.u1)), static_cast<float>(y(box.v1))}});
    const auto outputs = masks_->Run(inputs);
    if (!outputs) return tl::unexpected(outputs.error());
    const Tensor& drawn = outputs->at(0);
    const std::vector<float>& window = outputs->at(1).data;  // left, top, right, bottom, input px
    if (!(window[2] - window[0] >= 1 && window[3] - window[1] >= 1))
      return Fail(ErrorCode::kInvalid, "the second network answers for less than a pixel",
                  card_.decoder.file);
    ModelCard::Input grid;
    grid.width = static_cast<int>(drawn.shape[3]);
    grid.height = static_cast<int>(drawn.shape[2]);
    const double across = grid.width / (window[2] - window[0]);
    const double down = grid.height / (window[3] - window[1]);
    const Placement in_window{placement_.scale_x * across, placement_.scale_y * down,
                              (placement_.offset_x - window[0]) * across,
                              (placement_.offset_y - window[1]) * down};
    return ToFrameSize(drawn.data.data(), grid.height, grid.width, in_window, grid, width, height,
                       box);
  }

  /// Cells with the greatest heat of the 3 x 3 around them, with their boxes [input px].
  std::vector<FoundBox> Peaks(int label) const {
    const Tensor &heat = outputs_[kHeat], &box = outputs_[kBox];
    const int rows = static_cast<int>(heat.shape[2]), cols = static_cast<int>(heat.shape[3]);
    const std::size_t plane = static_cast<std::size_t>(rows) * cols;
    const float* at = &heat.data[static_cast<std::size_t>(label) * plane];
    const double cell_x = static_cast<double>(card_.input.width) / cols;
    const double cell_y = static_cast<double>(card_.input.height) / rows;
    std::vector<FoundBox> out;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < cols; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * cols + x;
        if (at[i] < card_.thresholds.score || !IsPeak(at, rows, cols, x, y)) continue;
        const double u = (x + 0.5) * cell_x, v = (y + 0.5) * cell_y;
        out.push_back({u - box.data[i], v - box.data[plane + i], u + box.data[2 * plane + i],
                       v + box.data[3 * plane + i], at[i], label, i});
      }
    return out;
  }

  /// Of equal neighbours the first is the peak.
  static bool IsPeak(const float* heat, int rows, int cols, int x, int y) {
    const int own = y * cols + x;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, rows - 1); ++ny)
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, cols - 1); ++nx) {
        const int other = ny * cols + nx;
        if (heat[other] > heat[own] || (heat[other] == heat[own] && other < own)) return false;
      }
    return true;
  }

  /// Class for which the box was found; for other boxes, the class that fills it most.
  int LabelIn(const PixelBox& box) const {
    for (const auto& [known, label] : found_)
      if (known.u0 == box.u0 && known.v0 == box.v0 && known.u1 == box.u1 && known.v1 == box.v1)
        return label;
    const Tensor& mask = outputs_[kMask];
    const int rows = static_cast<int>(mask.shape[2]), cols = static_cast<int>(mask.shape[3]);
    const auto cell = [](double px, double offset, double scale, int input, int cells) {
      return std::clamp(static_cast<int>((px * scale + offset) * cells / input), 0, cells - 1);
    };
    const Placement& p = placement_;
    const int x0 = cell(box.u0, p.offset_x, p.scale_x, card_.input.width, cols);
    const int x1 = cell(box.u1, p.offset_x, p.scale_x, card_.input.width, cols);
    const int y0 = cell(box.v0, p.offset_y, p.scale_y, card_.input.height, rows);
    const int y1 = cell(box.v1, p.offset_y, p.scale_y, card_.input.height, rows);
    int best = 0;
    double best_sum = -1;
    for (int label = 0; label < static_cast<int>(card_.labels.size()); ++label) {
      double sum = 0;
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          sum += mask.data[(static_cast<std::size_t>(label) * rows + y) * cols + x];
      if (sum <= best_sum) continue;
      best = label;
      best_sum = sum;
    }
    return best;
  }

  struct Found {
    PixelBox box;
    int label;
  };
  ModelCard card_;
  Network network_;
  std::optional<Network> masks_;
  TextTable texts_;
  double camera_height_m_;
  std::optional<FrameHash> seen_;  // frame of outputs_
  std::vector<Tensor> inputs_, outputs_;
  Placement placement_;
  std::vector<Found> found_;  // boxes returned for this frame
};

}  // namespace

Result<std::shared_ptr<Model>> OpenCrossnavNetwork(const ModelCard& card,
                                                   const ModelOptions& options) {
  constexpr int kStride = 4;
  const auto bad = [&](const char* what) {
    return Fail(ErrorCode::kInvalid, what, card.path.string());
  };
  if (card.labels.empty()) return bad("key \"labels\" is missing");
  if (card.input.width % kStride != 0 || card.input.height % kStride != 0)
    return bad("key \"input.width\" and height must be multiples of 4");
  if (card.input.resize != "plain") return bad("key \"input.resize\" must be plain");
  auto texts = TextTable::Read(card, card.output.dim);
  if (!texts) return tl::unexpected(texts.error());
  const std::int64_t goals = static_cast<std::int64_t>(card.labels.size());
  const std::int64_t height = card.input.height, width = card.input.width;
  const std::int64_t rows = height / kStride, cols = width / kStride;
  const Signature signature{{{card.PortName("image"), {1, 3, height, width}},
                             {card.PortName("depth"), {1, 1, height, width}},
                             {card.PortName("height"), {1, 1, height, width}}},
                            {{card.PortName("heat"), {1, goals, rows, cols}},
                             {card.PortName("box"), {1, 4, rows, cols}},
                             {card.PortName("mask"), {1, goals + 1, rows, cols}},
                             {card.PortName("stairs"), {1, 1, rows, cols}},
                             {card.PortName("dense"), {1, -1, -1, texts->dim()}}}};
  auto network = OpenNetwork(card, signature, options);
  if (!network) return tl::unexpected(network.error());
  std::optional<Network> masks;
  if (!card.decoder.file.empty()) {
    Signature second{signature.inputs, {{"mask", {1, 1, -1, -1}}, {"window", {1, 4}}}};
    second.inputs.push_back({"share", {1, 1, rows, cols}});
    second.inputs.push_back({"box", {1, 4}});
    auto opened = OpenDecoder(card, second, options);
    if (!opened) return tl::unexpected(opened.error());
    masks = std::move(*opened);
  }
  return std::make_shared<CrossnavModel>(card, std::move(*network), std::move(masks),
                                         std::move(*texts), options.camera_height_m);
}

}  // namespace crossnav::inference
