// SPDX-License-Identifier: MIT
// A goal that was described ("the red chair upstairs"): the category drives the search, and an
// object is claimed only where it fits the description as far as the map can tell. Objects that do
// not fit are left alone, those that may fit until nothing else is left. World frame, metres.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/language/description.h"
#include "crossnav/language/known_home.h"
#include "crossnav/perception/perception.h"
#include "crossnav/policy/claim.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::agent {

struct HistoryPoi;
struct GoalState;
struct StepState;
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
  bool takes_guesses = false;             ///< nothing is left to explore
  std::set<int> set_aside;                ///< ids of live POIs that do not fit
};

/// Nothing for a plain name. kInvalid: words that are not understood.
Result<std::optional<DescribedGoal>> DescribedGoalOf(const std::string& text,
                                                     perception::DenseEncoder& encoder);

/// Updates the known home of a described goal; does nothing for a plain goal.
void LookAtHome(const World& world, const Config& config, GoalState* goal);

/// Remembered places without those that do not fit, the fitting first.
std::vector<HistoryPoi> FittingPlaces(std::vector<HistoryPoi> places, const World& world,
                                      const GoalState& goal);

/// Sets live POIs aside that do not fit, and takes back those that do now.
void JudgeInstances(StepState& now);

/// The last resort: what may fit will do. False for plain goals, and where it was tried.
bool TakeGuesses(StepState& now);

}  // namespace crossnav::agent
