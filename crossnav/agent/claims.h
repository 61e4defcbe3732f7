// SPDX-License-Identifier: MIT
// Verification of claims in a step (verify.memory = on, policy.profile = full): calls the rules of
// policy/claim.h. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/perception/perception.h"

namespace crossnav::agent {

/// Whether claims are held against the memory at all.
bool DoubtsClaims(const Config& config);

/// Text vectors of the names that claims are held against, once for an encoder; names that it
/// cannot encode are left out.
void LearnNames(perception::DenseEncoder& encoder, const Config& config, World* world);

/// Sightings without rejected objects; POIs with new evidence become live again.
std::vector<policy::Sighting> WithoutRejected(std::vector<policy::Sighting> sightings,
                                              const Vector3d& p_camera_world, const Config& config,
                                              GoalState* goal);

/// The last word on a POI that this frame proves: kWeak has asked for a view from another side.
policy::ClaimVerdict CheckClaim(StepState& now, const policy::LivePoi& poi,
                                const policy::Verification& verification);

/// Gives up a POI: it, hints of it and remembered places on it are not tried again for this goal
/// until there is new evidence.
void Reject(StepState& now, const policy::LivePoi& poi);

/// Camera places that another view of this POI must differ from; empty where any view will do.
std::vector<Vector3d> ViewsToAvoid(const Situation& now, const policy::LivePoi& poi);

}  // namespace crossnav::agent
