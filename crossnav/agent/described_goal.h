// SPDX-License-Identifier: MIT
// A goal that was described ("the red chair upstairs"): the category drives the search, and an
// object is claimed only where it fits the description as far as the map can tell
// (wanted_instance.h). World frame, metres.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/language/description.h"
#include "crossnav/language/known_home.h"
#include "crossnav/language/resolve.h"
#include "crossnav/perception/perception.h"
#include "crossnav/policy/claim.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::agent {

struct GoalState;
struct World;
struct Config;

struct DescribedGoal {
  language::Description description;
  std::string category;                  ///< of its noun, as detectors know it: "tv_monitor"
  std::vector<policy::NamedText> names;  ///< what to look for in the memory to judge by
  std::string encoder_name;
  language::KnownHome home;                             ///< as of `home_step`
  int home_step = -1;                                   ///< -1 = not made yet
  std::shared_ptr<const scenegraph::SceneGraph> graph;  ///< its rooms
  std::optional<Vector3d> p_start_world;  ///< foot where the goal was given: ordinals count from it
};

/// Nothing for a plain name. kInvalid: words that are not understood.
Result<std::optional<DescribedGoal>> DescribedGoalOf(const std::string& text,
                                                     perception::DenseEncoder& encoder);

/// Updates the known home of a described goal; does nothing for a plain goal.
void LookAtHome(const World& world, const Config& config, GoalState* goal);

/// LookAtHome where the known home is old; notes where the goal was given.
void KeepHomeFresh(const World& world, const Config& config, const AgentPose& agent,
                   GoalState* goal);

/// How the object at `voxels` fits a described goal.
language::Fit FitOfDescription(const World& world, const GoalState& goal,
                               const std::vector<geometry::VoxelKey>& voxels,
                               const Vector3d& p_center_world);

}  // namespace crossnav::agent
