// SPDX-License-Identifier: MIT
// policy.profile = full: geometry leads. Ground that the robot can step onto is walkable on every
// floor and flight; what the agent is doing is one activity with a measure of progress, and what
// was tried is one record. The paper's order of candidates is kept as costs of classes.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// One decision of the full profile: what to do now, and with it the next action.
Decision Navigate(StepState& now);

}  // namespace crossnav::agent
