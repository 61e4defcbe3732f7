// SPDX-License-Identifier: MIT
// From a text to the numbers that a text network takes, equal to the tokenizers that such networks
// were trained with: byte-pair encoding as CLIP has it, and WordPiece as BERT (uncased) has it.
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
  /// Begin, tokens, end; as many tokens as fit into `length` numbers, which is at least 2.
  virtual std::vector<std::int32_t> Encode(std::string_view text, std::size_t length) const = 0;
  /// What fills a row behind the end.
  virtual std::int32_t Padding() const = 0;
};

/// From a file of merges: a header, then two parts a line (CLIP's bpe_simple_vocab_16e6.txt
/// unpacked, or merges.txt of transformers). Errors name the file and the line.
Result<std::unique_ptr<Tokenizer>> ReadClipTokenizer(const std::filesystem::path& merges);

/// From a vocabulary with a token a line (vocab.txt). Errors name the file; one without [UNK],
/// [CLS] or [SEP].
Result<std::unique_ptr<Tokenizer>> ReadWordPieceTokenizer(const std::filesystem::path& vocabulary);

}  // namespace crossnav::inference
