// SPDX-License-Identifier: MIT
#include "crossnav/inference/text_source.h"

#include <utility>

namespace crossnav::inference {

Result<TextSource> TextSource::Open(const ModelCard& card, int dim, const ModelOptions& options) {
  TextSource source;
  if (!card.text.table.empty() || card.text.encoder.empty()) {
    auto table = TextTable::Read(card, dim);
    if (!table) return tl::unexpected(table.error());
    source.table_ = std::move(*table);
  }
  if (card.text.encoder.empty()) return source;
  auto encoder = TextEncoder::Open(card, dim, options);
  if (!encoder) return tl::unexpected(encoder.error());
  source.encoder_ = std::move(*encoder);
  return source;
}

Result<std::vector<float>> TextSource::Of(std::string_view text) {
  if (table_) {
    auto own = table_->Of(text);
    if (own || !encoder_) return own;
  }
  return encoder_->Of(text);
}

}  // namespace crossnav::inference
