// SPDX-License-Identifier: MIT
// Search of a known house: an object that is at no known place is looked for by views, each worth
// the probability of what it shows for the first time. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/agent/exploration_prices.h"

namespace crossnav::agent {

/// Brings patches and the probabilities of the goal's search up to date, and begins a search where
/// one is due.
void UpdateSearch(StepState& now);

/// Begins a search under memory.mode = revise where no remembered place is left to visit.
void BeginSearchWhereDue(StepState& now);

/// Searches the house that was explored in vain, from near. False if a search is on already.
bool BeginCloseSearch(StepState& now);

/// Leaves out patches that no place within reach shows now. False where none is left out anew.
bool LeaveOutHidden(StepState& now);

/// Everything near enough counts as not looked at, at a shorter range.
void SearchNearer(StepState& now, double share_of_range);

/// Views, frontiers, flights and hints by the metres that each costs for its probability.
std::vector<PricedCandidate> PriceSearch(const Situation& now, const geometry::VoxelKey& start);

/// Whether the view still shows something for the first time.
bool IsViewOpen(const Situation& now, const policy::Candidate& view);
/// The view was taken: patches that it was to show are looked at.
void SettleView(StepState& now, const policy::Candidate& view);

/// Rooms that may hold the goal have no way to them now.
bool IsPartCutOff(const Situation& now);
/// memory.mode = revise: most was looked at; the agent gives up where no view is left.
bool IsSearchOver(const Situation& now);

}  // namespace crossnav::agent
