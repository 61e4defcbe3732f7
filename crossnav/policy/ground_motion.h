// SPDX-License-Identifier: MIT
// From a path over the ground to actions: a search over the poses that turns and steps reach. A
// turn begins only for the step after it, and headings do not oscillate. The body keeps clear of
// known obstacles. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/pose.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/planner/ground_search.h"
#include "crossnav/planner/planner_config.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Turns and forward steps that lead along `path` (places to stand, the agent's first), up to
/// `config.horizon_steps` of them or to its end, whichever is nearer. Empty where no step helps.
/// `rules` are the rules of the path's search.
std::vector<Action> MotionAlong(const planner::GroundMap& ground,
                                const std::vector<geometry::VoxelKey>& path, const AgentPose& agent,
                                const MotionConfig& config, const planner::PlannerConfig& planner,
                                const ActionConfig& action, const planner::GroundRules& rules = {});

/// Whether a forward step from `agent` keeps clear of the obstacles known by now.
bool IsStepClear(const planner::GroundMap& ground, const AgentPose& agent,
                 const MotionConfig& config, const ActionConfig& action);

}  // namespace crossnav::policy
