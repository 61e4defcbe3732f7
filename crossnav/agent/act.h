// SPDX-License-Identifier: MIT
// The next action of the activity in progress.
#pragma once

#include <optional>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// One action. nullopt while idle, or where the activity ended without one.
std::optional<Action> Act(StepState& now, const policy::Verification& verification);

}  // namespace crossnav::agent
