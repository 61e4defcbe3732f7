// SPDX-License-Identifier: MIT
// Inputs and result of one decision: the situation that a policy reads, the step state that it
// updates, and the decision that the agent executes and the trace shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/state.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/modes.h"

namespace crossnav::agent {

class Hooks;

/// Read-only view of one step. World frame, metres.
struct Situation {
  const Config& config;
  const World& world;
  const GoalState& goal;
  AgentPose agent;  ///< the robot's foot and heading
  AgentPose eye;    ///< foot point below the camera and its direction; differs by the mounting
  const Observation& obs;
  const std::vector<policy::Sighting>& sightings;  ///< of this frame
  Hooks* hooks = nullptr;                          ///< the user's decisions; may be null
};

/// The same with state that may change. Only the functions that take it update the agent.
struct StepState {
  const Config& config;
  World& world;
  GoalState& goal;
  AgentPose agent;
  AgentPose eye;
  const Observation& obs;
  const std::vector<policy::Sighting>& sightings;
  Hooks* hooks = nullptr;

  operator Situation() const {  // NOLINT(google-explicit-constructor): a view of the same step
    return {config, world, goal, agent, eye, obs, sightings, hooks};
  }
};

struct Decision {
  policy::ModeDecision mode{policy::Mode::kBasicExplore, policy::ModeReason::kExploring};
  std::optional<Action> action;  ///< nullopt = no candidate is left
  std::vector<policy::Candidate> shown;
  std::optional<policy::Candidate> target;
  std::vector<geometry::VoxelKey> path;
  double path_cost = 0;  ///< [voxels]
  policy::Verification verification;
  std::optional<Vector3d> p_claimed_world;  ///< with kStop
  std::string activity;                     ///< as in trace::StepTrace
};

}  // namespace crossnav::agent
