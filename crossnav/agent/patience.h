// SPDX-License-Identifier: MIT
// End of a search that finds nothing better than a claim that was put aside
// (policy.profile = full, verify.evidence = views).
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// Settles for the likeliest refuted claim once the search after it took `verify.patience` actions
/// times the probability that the claim is wrong. Claims that are more likely wrong than right wait
/// until nothing is left to see (SettleForLikeliest).
void LosePatience(StepState& now);

}  // namespace crossnav::agent
