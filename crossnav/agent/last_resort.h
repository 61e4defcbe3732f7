// SPDX-License-Identifier: MIT
// Last resorts of policy.profile = full, before "all explored" is declared.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Applies the next resort; each is used once for a goal. False if none is left.
bool TryLastResort(StepState& now);

/// Whether last resorts are left that drop marks of bumps, try narrow gaps, or leave out what
/// cannot be reached.
bool HasOpeningResort(const GoalState& goal);

/// An object that many frames showed weakly, and that no place in reach shows from near: marks of
/// bumps are dropped and narrow gaps are tried before the agent goes on exploring. Each is used
/// once for a goal.
void OpenWayToSteadySight(StepState& now);

}  // namespace crossnav::agent
