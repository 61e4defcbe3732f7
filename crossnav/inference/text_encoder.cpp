// SPDX-License-Identifier: MIT
#include "crossnav/inference/text_encoder.h"

#include <cmath>

#include "crossnav/core/category_table.h"

namespace crossnav::inference {
namespace {

constexpr const char* kBlank = "{}";

bool Normalize(std::vector<float>& v) {
  double squared = 0;
  for (const float x : v) squared += static_cast<double>(x) * x;
  if (!(squared > 1e-20)) return false;
  for (float& x : v) x = static_cast<float>(x / std::sqrt(squared));
  return true;
}

}  // namespace

Result<TextEncoder> TextEncoder::Open(const ModelCard& card, int dim, const ModelOptions& options) {
  const auto& text = card.text;
  if (text.tokenizer.empty() || text.vocabulary.empty())
    return Fail(ErrorCode::kInvalid, "keys \"text.tokenizer\" and vocabulary are missing",
                card.path.string());
  auto tokenizer = text.tokenizer == "clip" ? ReadClipTokenizer(text.vocabulary)
                                            : ReadWordPieceTokenizer(text.vocabulary);
  if (!tokenizer) return tl::unexpected(tokenizer.error());
  ModelCard own = card;
  own.file = text.encoder;
  own.sha256 = text.sha256;
  auto network =
      OpenNetwork(own, {{{"input_ids", {1, text.length}}}, {{"text_embeds", {1, dim}}}}, options);
  if (!network) return tl::unexpected(network.error());
  return TextEncoder(card, std::move(*network), std::move(*tokenizer));
}

Result<std::vector<float>> TextEncoder::Encode(const std::string& text) {
  const auto length = static_cast<std::size_t>(card_.text.length);
  const auto ids = tokenizer_->Encode(text, length);
  const auto padding =
      card_.text.padding == "zero" ? 0.0F : static_cast<float>(tokenizer_->Padding());
  Tensor input{"input_ids", {1, card_.text.length}, std::vector<float>(length, padding)};
  for (std::size_t i = 0; i < ids.size(); ++i) input.data[i] = static_cast<float>(ids[i]);
  auto outputs = network_.Run({&input, 1});
  if (!outputs) return tl::unexpected(outputs.error());
  std::vector<float> vector = std::move(outputs->front().data);
  if (!Normalize(vector))
    return Fail(ErrorCode::kMalformed, "gives no direction for \"" + text + "\"",
                card_.text.encoder.string());
  return vector;
}

Result<std::vector<float>> TextEncoder::Of(std::string_view text) {
  const std::string name = SpacedName(text);
  if (const auto known = known_.find(name); known != known_.end()) return known->second;
  std::vector<float> mean;
  for (std::string sentence : card_.text.templates) {
    if (const auto at = sentence.find(kBlank); at != std::string::npos)
      sentence.replace(at, 2, name);
    const auto vector = Encode(sentence);
    if (!vector) return vector;
    mean.resize(vector->size(), 0.0F);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (*vector)[i];
  }
  if (!Normalize(mean))
    return Fail(ErrorCode::kMalformed, "the vectors of \"" + name + "\" cancel out",
                card_.text.encoder.string());
  known_.emplace(name, mean);
  return mean;
}

}  // namespace crossnav::inference
