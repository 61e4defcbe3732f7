// SPDX-License-Identifier: MIT
// Outcome of the last action: bumps, levels, flights that were walked.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Marks the obstacle that stopped a forward step.
void NoteBump(StepState& now);

/// Sets the exploration level to the level that supports the agent. A walk from one level to
/// another makes a flight known.
void NoteLevel(StepState& now);

}  // namespace crossnav::agent
