// SPDX-License-Identifier: MIT
#include "crossnav/inference/text_table.h"

#include <cmath>

#include "crossnav/core/category_table.h"

namespace crossnav::inference {
namespace {

/// False for a zero vector.
bool NormalizeRow(std::vector<float>& v) {
  double squared = 0;
  for (const float x : v) squared += static_cast<double>(x) * x;
  if (squared < 1e-20) return false;
  for (float& x : v) x = static_cast<float>(x / std::sqrt(squared));
  return true;
}

}  // namespace

Result<TextTable> TextTable::Read(const ModelCard& card, int dim) {
  if (card.text.table.empty())
    return Fail(ErrorCode::kInvalid, "key \"text.table\" is missing", card.path.string());
  auto vectors = card.text.names_file.empty()
                     ? perception::ReadNamedVectors(card.text.names, card.text.table)
                     : perception::ReadNamedVectors(card.text.names_file, card.text.table);
  if (!vectors) return tl::unexpected(vectors.error());
  TextTable table;
  table.where_ = card.text.table.string();
  for (auto& [name, vector] : *vectors) {
    if (dim != 0 && static_cast<int>(vector.size()) != dim)
      return Fail(ErrorCode::kMismatch,
                  "holds vectors of " + std::to_string(vector.size()) +
                      " numbers, and the network's "
                      "features have " +
                      std::to_string(dim),
                  card.text.table.string());
    if (!NormalizeRow(vector))
      return Fail(ErrorCode::kInvalid, "the vector of \"" + name + "\" is zero",
                  card.text.table.string());
  }
  table.vectors_ = std::move(*vectors);
  return table;
}

Result<std::vector<float>> TextTable::Of(std::string_view text) const {
  const auto own = vectors_.find(SpacedName(text));
  if (own != vectors_.end()) return own->second;
  const std::string wanted = CanonicalName(text);
  std::vector<float> mean(vectors_.begin()->second.size(), 0.0F);
  for (const auto& [name, vector] : vectors_) {
    if (CanonicalName(name) != wanted) continue;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += vector[i];
  }
  if (NormalizeRow(mean)) return mean;
  return Fail(ErrorCode::kUnsupported, "has no vector for \"" + std::string(text) + "\"", where_);
}

}  // namespace crossnav::inference
