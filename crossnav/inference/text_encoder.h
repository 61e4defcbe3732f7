// SPDX-License-Identifier: MIT
// Text vectors from a network: any text, in the space of its image features. The vector of a text
// is the mean of the unit vectors over the card's templates ("a photo of a {}.").
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/inference/parts.h"
#include "crossnav/inference/tokenizer.h"

namespace crossnav::inference {

class TextEncoder {
 public:
  /// The card's `text.encoder`, with inputs `input_ids` 1 x length and output `text_embeds` 1 x
  /// dim. Errors name the file.
  static Result<TextEncoder> Open(const ModelCard& card, int dim, const ModelOptions& options);

  /// Unit vector; computed once for a text, then cached.
  Result<std::vector<float>> Of(std::string_view text);

 private:
  TextEncoder(ModelCard card, Network network, std::unique_ptr<Tokenizer> tokenizer)
      : card_(std::move(card)), network_(std::move(network)), tokenizer_(std::move(tokenizer)) {}
  Result<std::vector<float>> Encode(const std::string& text);

  ModelCard card_;
  Network network_;
  std::unique_ptr<Tokenizer> tokenizer_;
  std::map<std::string, std::vector<float>, std::less<>> known_;
};

}  // namespace crossnav::inference
