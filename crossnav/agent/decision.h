// SPDX-License-Identifier: MIT
// What a policy decides in one step, for the agent to execute and for the trace to show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/state.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/modes.h"

namespace crossnav::agent {

class Hooks;

/// What a policy looks at.
struct Situation {
  const Config& config;
  World& world;
  GoalState& goal;
  AgentPose agent;  ///< the robot's foot and where it faces
  AgentPose eye;    ///< below the camera and where that looks; differs where it is mounted so
  const Observation& obs;
  const std::vector<policy::Sighting>& sightings;  ///< of this frame
  Hooks* hooks = nullptr;                          ///< what the user decides; may be null
};

struct Decision {
  policy::ModeDecision mode{policy::Mode::kBasicExplore, policy::ModeReason::kExploring};
  std::optional<Action> action;  ///< nullopt = nothing is left to do
  std::vector<policy::Candidate> shown;
  std::optional<policy::Candidate> target;
  std::vector<geometry::VoxelKey> path;
  double path_cost = 0;  ///< [voxels]
  policy::Verification verification;
  std::optional<Vector3d> p_claimed_world;  ///< with kStop
  std::string activity;                     ///< as in trace::StepTrace
};

}  // namespace crossnav::agent
