// SPDX-License-Identifier: MIT
#include "crossnav/perception/perception.h"

#include <algorithm>
#include <utility>

namespace crossnav::perception {

Result<std::vector<std::vector<float>>> EncodeTexts(DenseEncoder& encoder,
                                                    std::span<const char* const> texts) {
  std::vector<std::vector<float>> vectors;
  std::string missing;
  for (const char* text : texts) {
    auto vector = encoder.EncodeText(text);
    if (vector) {
      vectors.push_back(std::move(*vector));
    } else if (vector.error().code == ErrorCode::kUnsupported) {
      missing += (missing.empty() ? "\"" : ", \"") + std::string(text) + "\"";
    } else {
      return tl::unexpected(vector.error());
    }
  }
  if (!vectors.empty()) return vectors;
  return Fail(ErrorCode::kUnsupported,
              "has a vector for none of " + missing + ", which query.relevancy = contrastive needs",
              encoder.Name());
}

Result<Percept> PerceptionSuite::Look(const Observation& obs, std::string_view goal) {
  Percept percept;
  auto detections = detector->Detect(obs, goal);
  if (!detections) return tl::unexpected(detections.error());
  for (Detection& detection : *detections) {
    if (auto done = segmenter->Segment(obs, detection); !done) return tl::unexpected(done.error());
  }
  std::stable_sort(
      detections->begin(), detections->end(),
      [](const Detection& a, const Detection& b) { return a.confidence > b.confidence; });
  percept.detections = std::move(*detections);

  auto stair_probability = stairs->SegmentStairs(obs);
  if (!stair_probability) return tl::unexpected(stair_probability.error());
  percept.stair_probability = std::move(*stair_probability);

  auto features = encoder->EncodeImage(obs);
  if (!features) return tl::unexpected(features.error());
  percept.features = std::move(*features);
  return percept;
}

}  // namespace crossnav::perception
