// SPDX-License-Identifier: MIT
// Questions about a home: "where did I last see a toilet?", "how many chairs are upstairs", "which
// rooms have no plant", "is there a bed on the first floor", "what is on the table". Plain data and
// its parser.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/language/description.h"

namespace crossnav::language {

enum class QuestionKind {
  kWhere,       ///< where is, where did I last see, when did I last see
  kHowMany,     ///< things
  kIsThere,     ///< is there, are there any
  kWhatIs,      ///< what is on the table, what is in the kitchen; the subject has no noun
  kWhichRooms,  ///< which rooms have (no); without a noun: all rooms of a floor
  kHowManyFloors
};
std::string_view NameOf(QuestionKind kind);

struct Question {
  QuestionKind kind = QuestionKind::kWhere;
  Description subject;
  bool is_negated = false;  ///< which rooms have no
  bool is_count = false;    ///< how many rooms
};

/// kInvalid names the unknown word and the words expected there.
Result<Question> ParseQuestion(std::string_view text);

/// Canonical categories that an answer needs: kinds of the subject and of its landmarks, and
/// categories that identify room types. For "what is ...", every known noun.
std::vector<std::string> NamesFor(const Question& question);
std::vector<std::string> NamesFor(const Description& description);

}  // namespace crossnav::language
