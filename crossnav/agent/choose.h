// SPDX-License-Identifier: MIT
// Choice of the next activity (paper, eq:supp_candidate_set and eq:supp_candidate_priority): a live
// POI before a remembered place before exploration. Choosing reads; Apply alone writes.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "crossnav/agent/pursuit.h"

namespace crossnav::agent {

/// Facts that choosing established, for Apply to remember.
struct Findings {
  std::optional<PathCheck> path;                      ///< of the pursuit in progress
  std::vector<std::optional<int>> unreachable_steps;  ///< of each remembered place, or empty
  bool has_found_descent = false;                     ///< the level has a flight down
  std::optional<policy::Relevancy> relevancy;         ///< refreshed
};

struct Keep {};  ///< goes on with the activity in progress
struct Drop {
  Ending ending;  ///< of the pursuit in progress; another choice follows
};
struct Take {
  Pursuit pursuit;
};
struct Glance {
  std::deque<Action> turns;  ///< not empty
};

struct Choice {
  std::variant<Keep, Drop, Take, Glance> next;
  Findings findings;
  std::vector<policy::Candidate> shown;  ///< for the trace
};

Choice Choose(const Situation& now);

/// Remembers the findings and carries the choice out.
void Apply(StepState& now, Choice choice);

}  // namespace crossnav::agent
