// SPDX-License-Identifier: MIT
// policy.profile = onemap: the baseline of the paper's tables, OneMap (Busch et al.,
// arXiv:2409.11764), on a 2D map. docs/onemap.md lists its implemented and omitted parts.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent::onemap {

/// One decision; see agent::Navigate.
Decision Decide(StepState& given);

}  // namespace crossnav::agent::onemap
