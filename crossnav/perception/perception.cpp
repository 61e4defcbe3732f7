// SPDX-License-Identifier: MIT
#include "crossnav/perception/perception.h"

#include <algorithm>
#include <utility>

namespace crossnav::perception {

Result<std::vector<std::vector<float>>> EncodeTexts(DenseEncoder& encoder,
                                                    std::span<const char* const> texts) {
  std::vector<std::vector<float>> vectors;
  for (const char* text : texts) {
    auto vector = encoder.EncodeText(text);
    if (!vector) return tl::unexpected(vector.error());
    vectors.push_back(std::move(*vector));
  }
  return vectors;
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
