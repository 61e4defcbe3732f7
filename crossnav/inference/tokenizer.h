// SPDX-License-Identifier: MIT
// Tokenizers: from a text to the numbers of a text network, equal to the tokenizers used in
// training: byte-pair encoding as in CLIP, and WordPiece as in BERT (uncased).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::inference {

class Tokenizer {
 public:
  virtual ~Tokenizer() = default;
  /// Begin, tokens, end; tokens beyond `length` numbers (at least 2) are cut off.
  virtual std::vector<std::int32_t> Encode(std::string_view text, std::size_t length) const = 0;
  /// Fills a row behind the end.
  virtual std::int32_t Padding() const = 0;
};

/// Reads a file of merges: a header, then two parts a line (CLIP's bpe_simple_vocab_16e6.txt
/// unpacked, or merges.txt of transformers). Errors name the file and the line.
Result<std::unique_ptr<Tokenizer>> ReadClipTokenizer(const std::filesystem::path& merges);

/// Reads a vocabulary with a token a line (vocab.txt). Errors name the file, also for a missing
/// [UNK], [CLS] or [SEP].
Result<std::unique_ptr<Tokenizer>> ReadWordPieceTokenizer(const std::filesystem::path& vocabulary);

}  // namespace crossnav::inference
