// SPDX-License-Identifier: MIT
// Vocabulary of YOLO-World: the card's labels, plus a goal that no label means.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/inference/tensor.h"
#include "crossnav/inference/text_source.h"

namespace crossnav::inference {

class Vocabulary {
 public:
  /// Computes the vectors of all labels, so that an error appears before anything runs.
  static Result<Vocabulary> Open(const ModelCard& card, const ModelOptions& options);

  /// The network's input `texts`, 1 x output.classes x output.dim, and in `labels` the places of
  /// the goal's words. Remaining places repeat a word, without effect: the network takes the best
  /// word of each cell. Error: no place or no vector for the goal.
  Result<Tensor> With(std::string_view goal, std::vector<int>& labels);

 private:
  Vocabulary(ModelCard card, TextSource source)
      : card_(std::move(card)), source_(std::move(source)) {}

  ModelCard card_;
  TextSource source_;
  std::vector<float> labels_;  // labels x dim
};

}  // namespace crossnav::inference
