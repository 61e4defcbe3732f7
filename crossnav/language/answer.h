// SPDX-License-Identifier: MIT
// Answers questions from a known home. Missing knowledge gives the answer "unknown": a room that
// was measured but not looked at may hold any object.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/language/known_home.h"
#include "crossnav/language/question.h"

namespace crossnav::language {

struct Answer {
  std::string text;             ///< sentences for people, one a line
  bool is_known = true;         ///< false: places not looked at could change the answer
  std::optional<bool> is_true;  ///< kIsThere: yes or no; empty = unknown
  std::optional<int> count;     ///< kHowMany: the number
  std::vector<int> things;      ///< indices into KnownHome, the last seen first
  std::vector<int> rooms;       ///< kWhichRooms: the certain rooms
  std::vector<int> unseen;      ///< rooms not looked at that could change the answer
};

Answer AnswerTo(const Question& question, const KnownHome& home);

/// "bedroom (room 4) on the first floor"
std::string PlaceText(const Thing& thing, const KnownHome& home);
/// "room 4 (bedroom) on the first floor"
std::string RoomText(int room, const KnownHome& home);
/// "ground floor", "first floor", "basement".
std::string FloorText(int floor, const KnownHome& home);

}  // namespace crossnav::language
