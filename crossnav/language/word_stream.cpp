// SPDX-License-Identifier: MIT
#include "crossnav/language/word_stream.h"

#include <algorithm>
#include <cctype>

namespace crossnav::language {
namespace {

constexpr std::size_t kMostWords = 60;  // chosen: a sentence

bool IsLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ||
         static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

Result<WordStream> WordStream::Of(std::string_view sentence) {
  WordStream stream;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) stream.words_.push_back(std::move(word));
    word.clear();
  };
  for (const char c : sentence) {
    if (c == '\'') continue;  // "what's"
    if (!IsLetter(c)) {
      finish();
      continue;
    }
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  finish();
  if (stream.words_.empty()) return Fail(ErrorCode::kInvalid, "there are no words to understand");
  if (stream.words_.size() > kMostWords)
    return Fail(ErrorCode::kInvalid,
                "more than " + std::to_string(kMostWords) + " words; say it in a shorter sentence");
  return stream;
}

bool WordStream::Take(std::initializer_list<std::string_view> phrases) {
  for (const std::string_view phrase : phrases) {
    const auto spaces = static_cast<std::size_t>(std::count(phrase.begin(), phrase.end(), ' '));
    if (at_ + spaces + 1 > words_.size() || Joined(spaces + 1) != phrase) continue;
    at_ += spaces + 1;
    return true;
  }
  return false;
}

void WordStream::DropLast(std::initializer_list<std::string_view> last) {
  if (!IsAtEnd() && std::find(last.begin(), last.end(), words_.back()) != last.end())
    words_.pop_back();
}

std::string WordStream::Quoted() const {
  std::string text = "\"";
  for (std::size_t i = 0; i < words_.size(); ++i) text += (i == 0 ? "" : " ") + words_[i];
  return text + "\"";
}

std::string WordStream::Joined(std::size_t count) const {
  std::string text = words_[at_];
  for (std::size_t i = 1; i < count; ++i) text += " " + words_[at_ + i];
  return text;
}

}  // namespace crossnav::language
