// SPDX-License-Identifier: MIT
// Where a card's text vectors come from: its table, its text network, or the network where the
// table has none.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/inference/text_encoder.h"
#include "crossnav/inference/text_table.h"

namespace crossnav::inference {

class TextSource {
 public:
  /// Vectors of `dim` numbers. Errors name the file, or the key that is missing.
  static Result<TextSource> Open(const ModelCard& card, int dim, const ModelOptions& options);

  /// Unit vector of `text`. Error: there is a table alone, and it has none.
  Result<std::vector<float>> Of(std::string_view text);

 private:
  std::optional<TextTable> table_;
  std::optional<TextEncoder> encoder_;
};

}  // namespace crossnav::inference
