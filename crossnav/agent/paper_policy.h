// SPDX-License-Identifier: MIT
// policy.profile = paper: the literal method. Strict planning on one level, stairs by verified
// entrances and sessions, the paper's strict order of candidates.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent::paper {

/// One decision of the paper's policy.
Decision Decide(StepState& now);

}  // namespace crossnav::agent::paper
