// SPDX-License-Identifier: MIT
// Parts of a decision that the profiles full and paper share. World frame, metres.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::agent {

/// Candidate of a POI without places to stand.
policy::Candidate CandidateOf(const policy::LivePoi& poi);
policy::Candidate CandidateOf(const HistoryPoi& poi);

trace::CandidateTrace TraceOf(const policy::Candidate& candidate, double voxel_m);

/// Settings as a profile uses them: published methods measure to the nearest voxel of an object.
Config OfProfile(Config config);

/// Verification of `poi` by the frame of this step; `found_confidence` stands for that of the
/// settings.
policy::Verification VerifyNow(const Situation& now, const policy::LivePoi& poi,
                               double found_confidence);

/// Distance from the foot position `p_foot` to the end of `path`, which is not empty [m]:
/// horizontal, and what it is above or below beyond two treads.
double DistanceToEndOf(const std::vector<geometry::VoxelKey>& path, const Vector3d& p_foot,
                       double voxel_m);

/// A full turn on the spot, with the camera one step towards `pitch_rad` first.
std::deque<Action> FullTurn(const AgentPose& agent, double pitch_rad, const ActionConfig& action);

/// Turns after aiming at a remembered place: a few more frames for the detector. chosen: one more
/// than a live POI needs to be stable.
inline constexpr std::array kWobble = {Action::kTurnLeft, Action::kTurnRight, Action::kTurnRight};

/// Makes the height `z_m` of the agent's foot the exploration level.
void EnterLevel(World& world, double z_m);

/// Appends the agent's foot position to the path off the level, at most one in half a voxel.
void NoteOffLevel(World& world, const Vector3d& p_foot, double voxel_m);

}  // namespace crossnav::agent
