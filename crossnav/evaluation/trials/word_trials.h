// SPDX-License-Identifier: MIT
// Descriptions of things in generated houses, drawn from the truth and resolved by a survey of the
// house: records of objects by ground-truth perception, rooms cut from the map's geometry.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/generation/word_drawing.h"
#include "crossnav/evaluation/settings/run_config.h"

namespace crossnav::evaluation {

struct WordScore {
  int count = 0, right = 0;
  int wrong = 0;    ///< of clear ones: another thing was found; of others: one was found
  int guesses = 0;  ///< answers that were not sure
  void Add(bool is_right, bool is_wrong);
  WordScore& operator+=(const WordScore& other);
};

struct WordFailure {
  WordKind kind = WordKind::kClear;
  std::string text, outcome;
};

struct WordTrial {
  std::string house;
  int things = 0, things_found = 0;  ///< that were seen well enough once; that have a record
  std::map<WordKind, WordScore> by_kind;
  std::map<std::string, WordScore> by_word;  ///< clear ones: colour, size, order, relation ...
  std::vector<WordFailure> failures;

  WordTrial& operator+=(const WordTrial& other);
};

struct WordTrialOptions {
  std::uint64_t seed = 301;
  int each = 12;  ///< descriptions of each kind
};

/// One house of the generator's second edition, surveyed.
Result<WordTrial> TryWords(const WordTrialOptions& options, const RunConfig& config);

}  // namespace crossnav::evaluation
