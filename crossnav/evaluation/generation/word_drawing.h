// SPDX-License-Identifier: MIT
// Draws descriptions of things in a home that is known exactly: such as mean one thing, several
// things, or none, by construction and with a margin: nothing may fit that does not.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/language/description.h"
#include "crossnav/language/known_home.h"

namespace crossnav::evaluation {

enum class WordKind { kClear, kAmbiguous, kImpossible };
inline constexpr int kWordKinds = 3;
std::string_view NameOf(WordKind kind);

struct DrawnWords {
  WordKind kind = WordKind::kClear;
  language::Description description;
  int thing = -1;  ///< with kClear: index into the home
};

/// Up to `count` of a kind, no two with the same text. Things of `nouns` alone are described, where
/// it is not empty; others are landmarks.
std::vector<DrawnWords> DrawWords(const language::KnownHome& home, WordKind kind, int count,
                                  const std::vector<std::string>& nouns, Rng& rng);

}  // namespace crossnav::evaluation
