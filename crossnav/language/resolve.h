// SPDX-License-Identifier: MIT
// Resolves a description to a thing of the known home. Readings: docs/lifelong.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/language/description.h"
#include "crossnav/language/known_home.h"

namespace crossnav::language {

enum class Outcome {
  kFound,
  kAmbiguous,  ///< several things fit equally well
  kAbsent,     ///< no thing fits, and every possible place was looked at
  kUnknown     ///< no known thing fits, but some places were not looked at
};
std::string_view NameOf(Outcome outcome);

struct Resolution {
  Outcome outcome = Outcome::kUnknown;
  std::vector<int> things;  ///< found: one; ambiguous: all that fit; indices into KnownHome
  bool is_sure = true;      ///< found: no part of the fit is kMaybe
  std::string reason;       ///< for people, of a failure: "2 rooms were not looked at"
};

Resolution Resolve(const Description& description, const KnownHome& home);

/// Fit of one thing without order and size, which compare all fitting things. Without a noun any
/// thing may fit.
Fit FitOf(const Description& description, const KnownHome& home, const Thing& thing);

/// Things with a fit of at least `least`, nearest to the robot first if its place is known.
std::vector<int> AllThatFit(const Description& description, const KnownHome& home, Fit least);

/// Possible floors of a phrase; empty if no such floor is known.
std::vector<int> FloorsOf(const FloorPhrase& phrase, const KnownHome& home);

/// Rooms not looked at that may be the description's room on its floor.
std::vector<int> UnseenRooms(const Description& description, const KnownHome& home);

}  // namespace crossnav::language
