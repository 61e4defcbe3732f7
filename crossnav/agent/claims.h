// SPDX-License-Identifier: MIT
// Verification of claims in a step (verify.memory = on, policy.profile = full): calls the rules of
// policy/claim.h. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/perception/perception.h"

namespace crossnav::agent {

/// Whether claims are compared with the memory.
bool DoubtsClaims(const Config& config);
/// Whether they are judged by all views, misses included (verify.evidence = views).
bool JudgesByViews(const Config& config);

/// Text vectors of the names that compete with claims, once for an encoder; names that the encoder
/// cannot encode are left out.
void LearnNames(perception::DenseEncoder& encoder, const Config& config, World* world);

/// Sightings without rejected objects; POIs with new evidence become live again.
std::vector<policy::Sighting> WithoutRejected(std::vector<policy::Sighting> sightings,
                                              const Vector3d& p_camera_world, const World& world,
                                              const Config& config, GoalState* goal);

/// Views that were noted since a rejection count. Objects below `least` by their views keep their
/// probability, because the memory's answer takes time.
void JudgeRejectedAgain(const World& world, const Config& config, double least, GoalState* goal);

/// Final verdict on a POI that this frame confirms; kWeak requests a view from another side.
policy::ClaimVerdict CheckClaim(StepState& now, const policy::LivePoi& poi,
                                const policy::Verification& verification);

/// The frames at the last viewpoints failed. True where all views together hold the claim
/// nevertheless (verify.evidence = views); the next frame claims it.
bool DecideByViews(StepState& now, const policy::LivePoi& poi);
/// No other view of a weak claim is within reach, or shows it: the memory decides, where the claim
/// was made (verify.evidence = frame). Once for a claim.
void GiveUpSecondView(StepState& now, int poi_id);
/// The same where the last viewpoints failed. False if the claim does not wait for a second view,
/// or did so before.
bool ReturnToClaim(StepState& now, const policy::LivePoi& poi);
/// Whether it was decided by views, and the agent is near enough for STOP.
bool IsDecidedByViews(const Situation& now, const policy::LivePoi& poi,
                      const policy::Verification& verification);

/// Whether the views of a POI refute it (verify.evidence = views), from wherever they were.
bool IsDisproved(const StepState& now, const policy::LivePoi& poi);

/// Hints that the frame shows in plain sight.
std::vector<policy::LivePoi> HintsInSight(const policy::LivePois& hints, const Observation& obs,
                                          const Config& config);

/// Whether views in plain sight say that a hint will never be claimed (verify.evidence = views).
bool IsHopelessHint(const Situation& now, const policy::LivePoi& hint);

/// Whether its sightings so far make it improbable: one more view that raises no confidence settles
/// it (verify.evidence = views).
bool IsUnlikelyHint(const Situation& now, const policy::LivePoi& hint);

/// Gives up a POI: it, hints of it and remembered places on it are not tried again for this goal
/// until there is new evidence.
void Reject(StepState& now, const policy::LivePoi& poi);

/// The camera of the view that supported a POI most, if the agent settled for it, or of the first
/// view that claimed it, if no second view does.
std::optional<Vector3d> ViewToReturnTo(const Situation& now, int poi_id);

/// Camera places that another view of this POI must differ from; empty where any view will do.
std::vector<Vector3d> ViewsToAvoid(const Situation& now, const policy::LivePoi& poi);

}  // namespace crossnav::agent
