// SPDX-License-Identifier: MIT
// History POIs for the goal's text, from the memory as it is (paper, "Query-Conditioned Retrieval").
#pragma once

#include <vector>

#include "crossnav/agent/state.h"

namespace crossnav::agent {

/// Best first; empty where the variant has no history POIs.
std::vector<HistoryPoi> RememberedPlaces(const World& world, const GoalState& goal,
                                         const Config& config);

}  // namespace crossnav::agent
