// SPDX-License-Identifier: MIT
// The answer to a question, from what is known of a home. What is not known is said to be unknown:
// a room that was measured but not looked at holds anything.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/language/known_home.h"
#include "crossnav/language/question.h"

namespace crossnav::language {

struct Answer {
  std::string text;             ///< sentences for people, one a line
  bool is_known = true;         ///< false: what was not looked at could change the answer
  std::optional<bool> is_true;  ///< is there: yes, no; empty = not known
  std::optional<int> count;     ///< how many
  std::vector<int> things;      ///< indices into KnownHome, the last seen first
  std::vector<int> rooms;       ///< which rooms: those that are sure
  std::vector<int> unseen;      ///< rooms that could change the answer
};

Answer AnswerTo(const Question& question, const KnownHome& home);

/// "bedroom (room 4) on the first floor"
std::string PlaceText(const Thing& thing, const KnownHome& home);
/// "room 4 (bedroom) on the first floor"
std::string RoomText(int room, const KnownHome& home);
/// "ground floor", "first floor", "basement".
std::string FloorText(int floor, const KnownHome& home);

}  // namespace crossnav::language
