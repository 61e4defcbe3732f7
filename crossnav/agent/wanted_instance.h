// SPDX-License-Identifier: MIT
// Goals that mean one instance of a category: by a description (described_goal.h) or by a picture
// (pictured_goal.h). Objects that do not fit are left alone, objects that may fit wait until
// nothing else is left. World frame, metres.
#pragma once

#include <set>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Remembered places without those that do not fit, the fitting first; unchanged for plain names.
std::vector<HistoryPoi> FittingPlaces(std::vector<HistoryPoi> places, const World& world,
                                      const GoalState& goal);

/// Sets live POIs aside that do not fit, and takes back those that do now.
void JudgeInstances(StepState& now);

/// The last resort: what may fit will do. False for plain goals, and where it was tried.
bool TakeGuesses(StepState& now);

}  // namespace crossnav::agent
