// SPDX-License-Identifier: MIT
// Source of a card's text vectors: its table, its text network, or the table with the network for
// missing texts.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/inference/text_encoder.h"
#include "crossnav/inference/text_table.h"

namespace crossnav::inference {

class TextSource {
 public:
  /// Vectors of `dim` numbers. Errors name the file, or the missing key.
  static Result<TextSource> Open(const ModelCard& card, int dim, const ModelOptions& options);

  /// Unit vector of `text`. Error: there is only a table, and it lacks the text.
  Result<std::vector<float>> Of(std::string_view text);

 private:
  std::optional<TextTable> table_;
  std::optional<TextEncoder> encoder_;
};

}  // namespace crossnav::inference
