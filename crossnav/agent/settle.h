// SPDX-License-Identifier: MIT
// The answer once nothing better is left to see: an object that was refuted, or seen too weakly to
// be claimed, becomes a POI that the next frame that confirms it claims.
#pragma once

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// The likeliest rejected object, by the views so far; null if none has at least this probability
/// (verify.evidence = views). Objects that the agent settled for before are left out.
const policy::RejectedObject* LikeliestRefuted(const Situation& now, double least_probability);

/// Settles for a rejected object.
void SettleFor(StepState& now, int poi_id);

/// Settles for the most confident refuted claim that many frames showed, else for a hint that many
/// frames showed with the secondary confidence. False without either (verify.evidence = frame).
bool SettleForSteadySight(StepState& now);

/// The hint that SettleForSteadySight would settle for; null without one.
const policy::LivePoi* SteadySight(const Situation& now);

/// memory.mode = revise, on a visit: record and frames agree. Settles for a hint at a believed
/// record's place that many frames showed with the secondary confidence. False without one.
bool SettleForSightAt(StepState& now, const HistoryPoi& place);

/// Settles for the likeliest rejected object (verify.settle, verify.evidence = views) or the
/// steadiest sight (frame). False without one.
bool SettleForLikeliest(StepState& now);

/// Confidence that a frame needs for STOP: policy.object.found_confidence, less where the agent
/// settled for a steady sight.
double ConfidenceForStop(const Situation& now, int poi_id);

}  // namespace crossnav::agent
