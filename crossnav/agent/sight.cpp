// SPDX-License-Identifier: MIT
#include "crossnav/agent/sight.h"

#include <algorithm>
#include <cmath>

namespace crossnav::agent {
namespace {

Image<float> SimilarityOf(const perception::FeatureGrid& grid, std::span<const float> text) {
  Image<float> cosine(grid.cols, grid.rows, 0.0F);
  const auto dim = static_cast<std::size_t>(grid.dim);
  if (text.size() != dim) return cosine;
  float text_squared = 0;
  for (const float x : text) text_squared += x * x;
  for (std::size_t cell = 0; cell < cosine.data.size(); ++cell) {
    const float* feature = &grid.data[cell * dim];
    float dot = 0, squared = 0;
    for (std::size_t i = 0; i < dim; ++i) {
      dot += feature[i] * text[i];
      squared += feature[i] * feature[i];
    }
    const float length = std::sqrt(squared * text_squared);
    if (length > 0 && std::isfinite(dot)) cosine.data[cell] = dot / length;
  }
  return cosine;
}

}  // namespace

trace::Sight SightOf(const perception::Percept& percept, std::span<const float> goal_text) {
  trace::Sight sight;
  sight.width_px = percept.stair_probability.width;
  sight.height_px = percept.stair_probability.height;
  for (const auto& detection : percept.detections) {
    const auto& box = detection.box;
    sight.boxes.push_back(
        {box.u0, box.v0, box.u1, box.v1, detection.confidence, detection.mask_quality});
    if (sight.masks.empty()) sight.masks = MaskImage(sight.width_px, sight.height_px, 0);
    for (std::size_t i = 0; i < detection.mask.data.size(); ++i)
      sight.masks.data[i] |= static_cast<std::uint8_t>(detection.mask.data[i] != 0);
  }
  sight.stair_probability = percept.stair_probability;
  sight.similarity = SimilarityOf(percept.features, goal_text);
  return sight;
}

}  // namespace crossnav::agent
