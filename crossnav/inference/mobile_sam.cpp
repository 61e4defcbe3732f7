// SPDX-License-Identifier: MIT
// MobileSAM and similar networks in two files, as exported by networks/paper/export.py: an encoder
// of the picture (`image` -> `embeddings`), run once a frame, and a decoder of one box
// (`embeddings`, `box` in input pixels -> `mask` logits on a grid over the input, `quality`).
#include <algorithm>
#include <cmath>

#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/parts.h"

namespace crossnav::inference {
namespace {

using perception::Detection;

class BoxMaskModel : public Model, public std::enable_shared_from_this<BoxMaskModel> {
 public:
  BoxMaskModel(ModelCard card, Network encoder, Network decoder)
      : card_(std::move(card)), encoder_(std::move(encoder)), decoder_(std::move(decoder)) {}
  std::unique_ptr<perception::Segmenter> MakeSegmenter() override {
    return std::make_unique<SegmenterOf<BoxMaskModel>>(shared_from_this());
  }

  Result<void> Segment(const Observation& obs, Detection& detection) {
    if (auto ok = Encode(obs.rgb); !ok) return ok;
    const auto& box = detection.box;
    const auto x = [&](int u) {
      return static_cast<float>(u * placement_.scale_x + placement_.offset_x);
    };
    const auto y = [&](int v) {
      return static_cast<float>(v * placement_.scale_y + placement_.offset_y);
    };
    const Tensor inputs[] = {embeddings_,
                             {"box", {1, 4}, {x(box.u0), y(box.v0), x(box.u1), y(box.v1)}}};
    const auto outputs = decoder_.Run(inputs);
    if (!outputs) return tl::unexpected(outputs.error());
    Fill(outputs->at(0), outputs->at(1).data[0], obs.rgb.width, obs.rgb.height, detection);
    return {};
  }

 private:
  Result<void> Encode(const RgbImage& rgb) {
    const auto is_same = [](const Rgb8& a, const Rgb8& b) {
      return a.r == b.r && a.g == b.g && a.b == b.b;
    };
    if (!embeddings_.data.empty() && seen_.width == rgb.width && seen_.height == rgb.height &&
        std::equal(rgb.data.begin(), rgb.data.end(), seen_.data.begin(), is_same))
      return {};
    embeddings_.data.clear();
    placement_ = PlacementOf(card_.input, rgb.width, rgb.height);
    Tensor image = ColourTensor(rgb, card_.input, "image");
    ClearOutside(rgb, image);
    auto outputs = encoder_.Run({&image, 1});
    if (!outputs) return tl::unexpected(outputs.error());
    embeddings_ = std::move(outputs->front());
    seen_ = rgb;
    return {};
  }

  /// SAM fills the area outside the picture with the mean colour, 0 after normalisation.
  void ClearOutside(const RgbImage& rgb, Tensor& image) const {
    const int width = card_.input.width, height = card_.input.height;
    const int right = static_cast<int>(std::lround(rgb.width * placement_.scale_x));
    const int bottom = static_cast<int>(std::lround(rgb.height * placement_.scale_y));
    for (int c = 0; c < 3; ++c)
      for (int v = 0; v < height; ++v) {
        float* row = &image.data[(static_cast<std::size_t>(c) * height + v) * width];
        std::fill(row + (v < bottom ? std::min(right, width) : 0), row + width, 0.0F);
      }
  }

  void Fill(const Tensor& logits, float quality, int width, int height,
            Detection& detection) const {
    const double p = std::clamp(card_.thresholds.mask, 1e-6, 1 - 1e-6);
    const auto least = static_cast<float>(std::log(p / (1 - p)));
    const Image<float> large =
        ToFrameSize(logits.data.data(), static_cast<int>(logits.shape[2]),
                    static_cast<int>(logits.shape[3]), placement_, card_.input, width, height);
    detection.mask = MaskImage(width, height);
    for (std::size_t i = 0; i < large.data.size(); ++i)
      detection.mask.data[i] = static_cast<std::uint8_t>(large.data[i] > least);
    detection.mask_quality = std::clamp(quality, 0.0F, 1.0F);
  }

  ModelCard card_;
  Network encoder_, decoder_;
  RgbImage seen_;  // picture of embeddings_
  Tensor embeddings_;
  Placement placement_;
};

}  // namespace

Result<std::shared_ptr<Model>> OpenMobileSam(const ModelCard& card, const ModelOptions& options) {
  const auto bad = [&](const char* what) {
    return Fail(ErrorCode::kInvalid, what, card.path.string());
  };
  const auto& o = card.output;
  if (card.decoder.file.empty()) return bad("key \"decoder\", the second file, is missing");
  if (card.input.layout != "chw" || card.input.resize == "letterbox")
    return bad("key \"input\": layout must be chw, and resize corner or plain");
  if (o.rows < 1 || o.cols < 1 || o.dim < 1)
    return bad("keys \"output.rows\", cols and dim, of the embeddings, are missing");
  const Shape embeddings{1, o.dim, o.rows, o.cols};
  auto encoder = OpenNetwork(
      card,
      {{{"image", {1, 3, card.input.height, card.input.width}}}, {{"embeddings", embeddings}}},
      options);
  if (!encoder) return tl::unexpected(encoder.error());
  auto decoder = OpenDecoder(card,
                             {{{"embeddings", embeddings}, {"box", {1, 4}}},
                              {{"mask", {1, 1, -1, -1}}, {"quality", {1, 1}}}},
                             options);
  if (!decoder) return tl::unexpected(decoder.error());
  return std::make_shared<BoxMaskModel>(card, std::move(*encoder), std::move(*decoder));
}

}  // namespace crossnav::inference
