// SPDX-License-Identifier: MIT
#include "crossnav/language/answer.h"
#include "crossnav/language/parse_description.h"
#include "crossnav/language/resolve.h"
#include "fuzz/harness.h"
#include "language/small_home.h"

// A goal or a question, one a line, about a small home.
FUZZ(words, input) {
  static const crossnav::language::SmallHome small;
  std::string text = crossnav::fuzz::Text(input);
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    if (const auto description = crossnav::language::ParseDescription(line)) {
      (void)Resolve(*description, small.home);
      if (!crossnav::language::ParseDescription(TextOf(*description))) std::abort();
    }
    if (const auto question = crossnav::language::ParseQuestion(line))
      (void)AnswerTo(*question, small.home);
    (void)crossnav::language::IsDescription(line);
  }
}
