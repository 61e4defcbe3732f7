// SPDX-License-Identifier: MIT
#include <array>

#include "crossnav/inference/parts.h"

namespace crossnav::inference {
namespace {

constexpr std::array kFamilies = {
    Family{"crossnav", "our network: colour, depth and height in, every head out",
           "detector segmenter stairs encoder", &OpenCrossnavNetwork},
    Family{"detr", "DEIM, D-FINE or RT-DETR with labels, boxes and scores",
           "detector second_detector", &OpenDetrDetector},
    Family{"yolov8", "YOLOv8, YOLOv11 or YOLO-World with baked words", "detector", &OpenYolo8},
    Family{"yolov8-seg", "YOLOv8 with masks", "detector segmenter", &OpenYolo8Segment},
    Family{"yolo-world", "YOLO-World that is given its words", "detector", &OpenYoloWorld},
    Family{"yolov7", "YOLOv7 with its grid", "detector", &OpenYolo7},
    Family{"yolov7-end2end", "YOLOv7 that suppresses doubles itself", "detector",
           &OpenYolo7EndToEnd},
    Family{"yolox", "YOLOX", "detector", &OpenYoloX},
    Family{"segformer", "SegFormer: the sum of its stair classes", "stairs", &OpenSegFormer},
    Family{"mobile-sam", "MobileSAM: an encoder and a decoder of boxes", "segmenter",
           &OpenMobileSam},
    Family{"dense", "dense image features with a table of text vectors", "encoder", &OpenDense},
};

}  // namespace

Result<std::vector<FoundBox>> Model::DetectAll(const Observation& /*obs*/, double /*least*/) {
  return Fail(ErrorCode::kUnsupported, "is no second detector", "networks.second_detector");
}

std::span<const Family> Families() {
  return kFamilies;
}

Result<const Family*> FamilyOf(const ModelCard& card) {
  std::string all;
  for (const Family& family : kFamilies) {
    if (card.family == family.name) return &family;
    all += (all.empty() ? "" : ", ") + std::string(family.name);
  }
  return Fail(ErrorCode::kUnsupported,
              "key \"family\": no adapter \"" + card.family + "\"; there are " + all,
              card.path.string());
}

Result<std::shared_ptr<Model>> Open(const ModelCard& card, const ModelOptions& options) {
  const auto family = FamilyOf(card);
  if (!family) return tl::unexpected(family.error());
  return (*family)->open(card, options);
}

Result<Network> OpenNetwork(const ModelCard& card, const Signature& signature,
                            const ModelOptions& options) {
  const auto bytes = ReadNetworkFile(card);
  if (!bytes) return tl::unexpected(bytes.error());
  return Network::FromBytes(*bytes, signature, options.session, card.file.string());
}

Result<Network> OpenDecoder(ModelCard card, const Signature& signature,
                            const ModelOptions& options) {
  card.file = card.decoder.file;
  card.sha256 = card.decoder.sha256;
  return OpenNetwork(card, signature, options);
}

std::string EncoderNameOf(const ModelCard& card) {
  constexpr std::size_t kShown = 12;
  return card.sha256.empty() ? card.name() : card.name() + "-" + card.sha256.substr(0, kShown);
}

}  // namespace crossnav::inference
