// SPDX-License-Identifier: MIT
// A sentence as words, taken from the front. Taking never fails: an unknown word stays in the
// stream.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::language {

class WordStream {
 public:
  /// Lower case, no punctuation; "tv_monitor" is two words. kInvalid: no words, or too many.
  static Result<WordStream> Of(std::string_view sentence);

  bool IsAtEnd() const { return at_ >= words_.size(); }
  /// The next word; empty at the end.
  std::string_view Next() const { return IsAtEnd() ? std::string_view() : words_[at_]; }
  std::size_t Mark() const { return at_; }
  void Return(std::size_t mark) { at_ = mark; }

  /// Takes the next words if they are one of `phrases`; the first match.
  bool Take(std::initializer_list<std::string_view> phrases);

  /// Removes the last word if it is one of `last` and not taken yet.
  void DropLast(std::initializer_list<std::string_view> last);

  /// Takes the longest phrase of `table` that comes next.
  template <class T>
  std::optional<T> TakeFrom(const WordTable<T>& table) {
    for (std::size_t count = kLongest; count > 0; --count) {
      if (at_ + count > words_.size()) continue;
      const auto found = table.find(Joined(count));
      if (found == table.end()) continue;
      at_ += count;
      return found->second;
    }
    return std::nullopt;
  }

  /// The sentence, for Error::where.
  std::string Quoted() const;

 private:
  static constexpr std::size_t kLongest = 4;
  std::string Joined(std::size_t count) const;

  std::vector<std::string> words_;
  std::size_t at_ = 0;
};

}  // namespace crossnav::language
