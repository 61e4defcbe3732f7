// SPDX-License-Identifier: MIT
#include "crossnav/inference/vocabulary.h"

#include <utility>

#include "crossnav/inference/boxes.h"

namespace crossnav::inference {

Result<Vocabulary> Vocabulary::Open(const ModelCard& card, const ModelOptions& options) {
  const auto bad = [&](const char* what) {
    return Fail(ErrorCode::kInvalid, what, card.path.string());
  };
  if (card.output.classes < 1)
    return bad("key \"output.classes\", the number of texts that the network takes, is missing");
  if (card.output.dim < 1)
    return bad("key \"output.dim\", the length of a text's vector, is missing");
  auto source = TextSource::Open(card, card.output.dim, options);
  if (!source) return tl::unexpected(source.error());
  Vocabulary words(card, std::move(*source));
  for (const std::string& label : card.labels) {
    const auto vector = words.source_.Of(label);
    if (!vector) return tl::unexpected(vector.error());
    words.labels_.insert(words.labels_.end(), vector->begin(), vector->end());
  }
  return words;
}

Result<Tensor> Vocabulary::With(std::string_view goal, std::vector<int>& labels) {
  labels = LabelsOf(goal, card_.labels);
  const auto dim = static_cast<std::size_t>(card_.output.dim);
  std::vector<float> rest;
  if (!labels.empty()) {
    rest.assign(labels_.begin(), labels_.begin() + card_.output.dim);
  } else {
    const int free_place = static_cast<int>(card_.labels.size());
    if (free_place >= card_.output.classes) return NoSuchLabel(goal, card_);
    auto vector = source_.Of(goal);
    if (!vector) return tl::unexpected(vector.error());
    rest = std::move(*vector);
    labels = {free_place};
  }
  Tensor texts{"texts", {1, card_.output.classes, card_.output.dim}, labels_};
  for (std::size_t i = card_.labels.size();
       i * dim < static_cast<std::size_t>(CountOf(texts.shape)); ++i)
    texts.data.insert(texts.data.end(), rest.begin(), rest.end());
  return texts;
}

}  // namespace crossnav::inference
