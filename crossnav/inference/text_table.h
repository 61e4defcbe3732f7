// SPDX-License-Identifier: MIT
// Text vectors from a table, in the space of a network's dense features.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "crossnav/inference/model_card.h"
#include "crossnav/perception/named_vectors.h"

namespace crossnav::inference {

class TextTable {
 public:
  /// Reads the card's table. Errors name the file, also for vectors that are not `dim` long, unless
  /// that is 0.
  static Result<TextTable> Read(const ModelCard& card, int dim);

  int dim() const { return static_cast<int>(vectors_.begin()->second.size()); }

  /// Unit vector of `text`: of its own name if the table has it, else the mean of all names of the
  /// same category (core/category_table.h). Error: the table has neither.
  Result<std::vector<float>> Of(std::string_view text) const;

  const perception::NamedVectors& vectors() const { return vectors_; }

 private:
  std::string where_;
  perception::NamedVectors vectors_;  // unit vectors
};

}  // namespace crossnav::inference
