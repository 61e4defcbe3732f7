// SPDX-License-Identifier: MIT
// The words that YOLO-World looks for: the card's labels, and a goal that none of them means.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/inference/tensor.h"
#include "crossnav/inference/text_source.h"

namespace crossnav::inference {

class Vocabulary {
 public:
  /// Asks for the vectors of all labels, so that an error is seen before anything runs.
  static Result<Vocabulary> Open(const ModelCard& card, const ModelOptions& options);

  /// The network's input `texts`, 1 x output.classes x output.dim, and in `labels` the places of
  /// the goal's words. Places that are left over repeat a word, which changes nothing: the network
  /// takes the best word of each cell. Error: there is no place or no vector for the goal.
  Result<Tensor> With(std::string_view goal, std::vector<int>& labels);

 private:
  Vocabulary(ModelCard card, TextSource source)
      : card_(std::move(card)), source_(std::move(source)) {}

  ModelCard card_;
  TextSource source_;
  std::vector<float> labels_;  // labels x dim
};

}  // namespace crossnav::inference
