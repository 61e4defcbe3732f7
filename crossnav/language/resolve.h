// SPDX-License-Identifier: MIT
// The thing that a description means, among those that are known. Readings: docs/lifelong.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/language/description.h"
#include "crossnav/language/known_home.h"

namespace crossnav::language {

enum class Outcome {
  kFound,
  kAmbiguous,  ///< several fit as well
  kAbsent,     ///< none fits, and every place where it could be was looked at
  kUnknown     ///< none that is known fits; there are places that nobody looked at
};
std::string_view NameOf(Outcome outcome);

struct Resolution {
  Outcome outcome = Outcome::kUnknown;
  std::vector<int> things;  ///< found: it alone; ambiguous: all of them; indices into KnownHome
  bool is_sure = true;      ///< found: nothing about it is a guess
  std::string reason;       ///< for people, why not found: "2 rooms were not looked at"
};

Resolution Resolve(const Description& description, const KnownHome& home);

/// How well a thing fits, but for order and size, which say something of all that fit. Without a
/// noun anything may fit.
Fit FitOf(const Description& description, const KnownHome& home, const Thing& thing);

/// Things of the kind that fit at least so well, by the distance to the robot where it stands
/// somewhere.
std::vector<int> AllThatFit(const Description& description, const KnownHome& home, Fit least);

/// Floors that a phrase can mean; empty where no such floor is known.
std::vector<int> FloorsOf(const FloorPhrase& phrase, const KnownHome& home);

/// Rooms where something in that room and on that floor may be, that were not looked at.
std::vector<int> UnseenRooms(const Description& description, const KnownHome& home);

}  // namespace crossnav::language
