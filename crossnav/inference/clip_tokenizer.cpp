// SPDX-License-Identifier: MIT
#include <array>
#include <limits>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>

#include "crossnav/core/read_file.h"
#include "crossnav/inference/tokenizer.h"
#include "crossnav/inference/unicode.h"

namespace crossnav::inference {
namespace {

constexpr std::uintmax_t kMostClipBytes = 64U << 20U;
constexpr std::size_t kMerges = 49152 - 256 - 2;  // number of merges that CLIP uses of its file
constexpr const char* kWordEnd = "</w>";

/// The visible character for each byte, in UTF-8; and the bytes in the order of CLIP's vocabulary.
struct ByteTable {
  std::array<std::string, 256> text;
  std::vector<int> order;

  ByteTable() {
    std::array<bool, 256> is_listed{};
    const auto add = [&](int first, int last) {
      for (int b = first; b <= last; ++b) {
        is_listed[static_cast<std::size_t>(b)] = true;
        text[static_cast<std::size_t>(b)] = ToUtf8(std::u32string(1, static_cast<char32_t>(b)));
        order.push_back(b);
      }
    };
    add('!', '~');
    add(0xA1, 0xAC);
    add(0xAE, 0xFF);
    char32_t next = 256;
    for (int b = 0; b < 256; ++b) {
      if (is_listed[static_cast<std::size_t>(b)]) continue;
      text[static_cast<std::size_t>(b)] = ToUtf8(std::u32string(1, next++));
      order.push_back(b);
    }
  }
};

class ClipTokenizer : public Tokenizer {
 public:
  ClipTokenizer() {
    for (const int b : bytes_.order) Add(bytes_.text[static_cast<std::size_t>(b)]);
    for (const int b : bytes_.order) Add(bytes_.text[static_cast<std::size_t>(b)] + kWordEnd);
  }

  void AddMerge(const std::string& left, const std::string& right) {
    ranks_.emplace(left + " " + right, static_cast<int>(ranks_.size()));
    Add(left + right);
  }

  std::vector<std::int32_t> Encode(std::string_view text, std::size_t length) const override {
    const auto begin = static_cast<std::int32_t>(ids_.size());
    std::vector<std::int32_t> out{begin};
    for (const std::string& word : Words(text)) AppendWord(word, out);
    if (out.size() > length - 1) out.resize(length - 1);
    out.push_back(begin + 1);
    return out;
  }

  std::int32_t Padding() const override { return static_cast<std::int32_t>(ids_.size()) + 1; }

 private:
  void Add(const std::string& token) {
    ids_.emplace(token, static_cast<std::int32_t>(ids_.size()));
  }

  /// CLIP's pattern: contractions, runs of letters, single digits, runs of anything else.
  static std::vector<std::string> Words(std::string_view raw) {
    const std::u32string text = Lower(Nfc(FromUtf8(raw)));
    const auto is_rest = [](char32_t c) {
      return !Is(CharClass::kSpace, c) && !Is(CharClass::kLetter, c) && !Is(CharClass::kNumber, c);
    };
    std::vector<std::string> words;
    for (std::size_t i = 0; i < text.size();) {
      std::size_t end = i + Contraction(text, i);
      if (end == i && Is(CharClass::kLetter, text[i]))
        while (end < text.size() && Is(CharClass::kLetter, text[end])) ++end;
      if (end == i && Is(CharClass::kNumber, text[i])) ++end;
      if (end == i)
        while (end < text.size() && is_rest(text[end])) ++end;
      if (end == i) {
        ++i;  // skips a space
        continue;
      }
      words.push_back(ToUtf8(std::u32string_view(text).substr(i, end - i)));
      i = end;
    }
    return words;
  }

  static std::size_t Contraction(const std::u32string& text, std::size_t at) {
    for (const std::u32string_view c : {U"'s", U"'t", U"'re", U"'ve", U"'m", U"'ll", U"'d"})
      if (text.compare(at, c.size(), c) == 0) return c.size();
    return 0;
  }

  void AppendWord(const std::string& word, std::vector<std::int32_t>& out) const {
    std::vector<std::string> parts;
    for (const char c : word) parts.push_back(bytes_.text[static_cast<unsigned char>(c)]);
    parts.back() += kWordEnd;
    while (parts.size() > 1) {
      int best = std::numeric_limits<int>::max();
      for (std::size_t i = 0; i + 1 < parts.size(); ++i) best = std::min(best, Rank(parts, i));
      if (best == std::numeric_limits<int>::max()) break;
      for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        if (Rank(parts, i) != best) continue;
        parts[i] += parts[i + 1];
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      }
    }
    for (const std::string& part : parts) {
      const auto id = ids_.find(part);
      out.push_back(id == ids_.end() ? Padding() : id->second);
    }
  }

  int Rank(const std::vector<std::string>& parts, std::size_t i) const {
    const auto rank = ranks_.find(parts[i] + " " + parts[i + 1]);
    return rank == ranks_.end() ? std::numeric_limits<int>::max() : rank->second;
  }

  ByteTable bytes_;
  std::unordered_map<std::string, int> ranks_;
  std::unordered_map<std::string, std::int32_t> ids_;
};

}  // namespace

Result<std::unique_ptr<Tokenizer>> ReadClipTokenizer(const std::filesystem::path& merges) {
  const auto text = ReadFile(merges, kMostClipBytes);
  if (!text) return tl::unexpected(text.error());
  auto tokenizer = std::make_unique<ClipTokenizer>();
  std::istringstream lines(*text);
  std::string line;
  std::getline(lines, line);
  if (line.find("#version") == std::string::npos)
    return Fail(ErrorCode::kMalformed, "is no file of merges: its first line has no \"#version\"",
                merges.string());
  std::size_t count = 0;
  for (; count < kMerges && std::getline(lines, line); ++count) {
    const auto blank = line.find(' ');
    if (blank == std::string::npos || blank == 0 || blank + 1 == line.size())
      return Fail(ErrorCode::kMalformed, "two parts are missing",
                  merges.string() + ": line " + std::to_string(count + 2));
    tokenizer->AddMerge(line.substr(0, blank), line.substr(blank + 1));
  }
  if (count == 0) return Fail(ErrorCode::kMalformed, "holds no merges", merges.string());
  return tokenizer;
}

}  // namespace crossnav::inference
