// SPDX-License-Identifier: MIT
#include <algorithm>
#include <sstream>
#include <string>
#include <unordered_map>

#include "crossnav/core/read_file.h"
#include "crossnav/inference/tokenizer.h"
#include "crossnav/inference/unicode.h"

namespace crossnav::inference {
namespace {

constexpr std::uintmax_t kMostWordPieceBytes = 64U << 20U;
constexpr std::size_t kLongestWord = 100;  // characters; BERT's

bool IsCjk(char32_t c) {
  struct Block {
    char32_t first, last;
  };
  constexpr Block kBlocks[] = {{0x4E00, 0x9FFF},   {0x3400, 0x4DBF},   {0x20000, 0x2A6DF},
                               {0x2A700, 0x2B73F}, {0x2B740, 0x2B81F}, {0x2B920, 0x2CEAF},
                               {0xF900, 0xFAFF},   {0x2F800, 0x2FA1F}};
  return std::any_of(std::begin(kBlocks), std::end(kBlocks),
                     [c](const Block& b) { return c >= b.first && c <= b.last; });
}

bool IsBlank(char32_t c) {
  return c == '\t' || c == '\n' || c == '\r' || Is(CharClass::kSpace, c);
}

bool IsPunctuation(char32_t c) {
  const bool is_ascii_symbol = (c >= '!' && c <= '/') || (c >= ':' && c <= '@') ||
                               (c >= '[' && c <= '`') || (c >= '{' && c <= '~');
  return is_ascii_symbol || Is(CharClass::kPunctuation, c);
}

/// Words and single punctuation marks, in lower case and without accents.
std::vector<std::u32string> Words(std::string_view raw) {
  std::u32string clean;
  for (const char32_t c : FromUtf8(raw)) {
    if (c == 0 || c == 0xFFFD || (Is(CharClass::kOther, c) && !IsBlank(c))) continue;
    if (IsCjk(c)) {
      clean += U' ';
      clean += c;
      clean += U' ';
    } else {
      clean += IsBlank(c) ? U' ' : c;
    }
  }
  std::u32string plain = Nfd(clean);
  std::erase_if(plain, [](char32_t c) { return Is(CharClass::kMark, c); });
  std::vector<std::u32string> words;
  bool is_open = false;
  for (const char32_t c : Lower(plain)) {
    const bool is_alone = IsPunctuation(c);
    if (IsBlank(c)) {
      is_open = false;
    } else if (is_open && !is_alone) {
      words.back() += c;
    } else {
      words.emplace_back(1, c);
      is_open = !is_alone;
    }
  }
  return words;
}

class WordPieceTokenizer : public Tokenizer {
 public:
  std::unordered_map<std::string, std::int32_t> ids;
  std::int32_t begin = 0, end = 0, unknown = 0, padding = 0;

  std::vector<std::int32_t> Encode(std::string_view text, std::size_t length) const override {
    std::vector<std::int32_t> out{begin};
    for (const std::u32string& word : Words(text)) AppendWord(word, out);
    if (out.size() > length - 1) out.resize(length - 1);
    out.push_back(end);
    return out;
  }
  std::int32_t Padding() const override { return padding; }

 private:
  /// Greedy longest match of known pieces; [UNK] if a part is unknown.
  void AppendWord(const std::u32string& word, std::vector<std::int32_t>& out) const {
    const std::size_t before = out.size();
    for (std::size_t from = 0; from < word.size();) {
      std::size_t to = word.size() > kLongestWord ? from : word.size();
      for (; to > from; --to) {
        const std::string piece = ToUtf8(std::u32string_view(word).substr(from, to - from));
        const auto id = ids.find(from == 0 ? piece : "##" + piece);
        if (id == ids.end()) continue;
        out.push_back(id->second);
        break;
      }
      if (to == from) {
        out.resize(before);
        out.push_back(unknown);
        return;
      }
      from = to;
    }
  }
};

}  // namespace

Result<std::unique_ptr<Tokenizer>> ReadWordPieceTokenizer(const std::filesystem::path& vocabulary) {
  const auto text = ReadFile(vocabulary, kMostWordPieceBytes);
  if (!text) return tl::unexpected(text.error());
  auto tokenizer = std::make_unique<WordPieceTokenizer>();
  std::istringstream lines(*text);
  std::int32_t next = 0;
  for (std::string line; std::getline(lines, line); ++next) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    tokenizer->ids.emplace(line, next);
  }
  const auto take = [&](const char* token, std::int32_t& id) {
    const auto it = tokenizer->ids.find(token);
    if (it != tokenizer->ids.end()) id = it->second;
    return it != tokenizer->ids.end();
  };
  take("[PAD]", tokenizer->padding);
  if (!take("[CLS]", tokenizer->begin) || !take("[SEP]", tokenizer->end) ||
      !take("[UNK]", tokenizer->unknown))
    return Fail(ErrorCode::kMalformed, "is no vocabulary: [CLS], [SEP] or [UNK] is missing",
                vocabulary.string());
  return tokenizer;
}

}  // namespace crossnav::inference
