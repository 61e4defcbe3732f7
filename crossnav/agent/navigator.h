// SPDX-License-Identifier: MIT
// policy.profile = full: geometry leads. Ground that the robot can step onto is walkable on every
// floor and flight. The agent is in one activity with a measure of progress; one record lists the
// attempts. The paper's order of candidates appears as prices of classes.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// One decision of the full profile: the activity and its next action.
Decision Navigate(StepState& now);

}  // namespace crossnav::agent
