// SPDX-License-Identifier: MIT
// policy.profile = paper. From candidates to a planned target: which frontier, which POI, which
// stair frontier. Functions of the world and the goal's state; each returns a target with its plan,
// or nothing.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/observation_place.h"
#include "crossnav/agent/state.h"
#include "crossnav/planner/astar.h"

namespace crossnav::agent::paper {

/// Inputs of all target functions.
struct Situation {
  const Config& config;
  World& world;
  GoalState& goal;
  AgentPose agent;
  AgentPose eye;  ///< as in agent::Situation
  std::optional<geometry::VoxelKey>
      start;  ///< where a plan begins; nullopt = standing nowhere known
  const std::set<geometry::VoxelKey>* obstacles = nullptr;
};

struct Target {
  policy::Candidate candidate;
  planner::Plan plan;
  planner::GraphRules rules;
};

/// Rules of the graph of Basic Explore: this level only, unless the agent has strayed from it.
planner::GraphRules LevelRules(const Situation& now);
/// Rules of POI navigation: everything pathable, stairs included.
planner::GraphRules WholeMapRules(const Situation& now);

/// The nearest candidate of one class; commits to it.
std::optional<Target> ChooseFrontier(Situation& now,
                                     const std::vector<policy::Candidate>& candidates);

/// Traversable, then descend and ascent frontiers of the level, without blacklisted candidates.
std::vector<policy::Candidate> OpenFrontiers(const Situation& now);
std::vector<policy::Candidate> OpenEntrances(const Situation& now, double level_m,
                                             bool include_walked);

/// Target of Basic Explore: the committed candidate during its grace period, else the nearest of
/// the first class that has one. nullopt when nothing is left on this level and no stairs lead on.
std::optional<Target> ChooseExploration(Situation& now, std::vector<policy::Candidate>* shown);

/// Viewpoint of the best stable live POI; `id` gets the POI.
std::optional<Target> ChooseLivePoi(const Situation& now, int* id);
/// Observation position of the best history POI that is left; `index` gets it.
std::optional<Target> ChooseHistoryPoi(Situation& now, int* index);
/// Stair frontier with the highest progress that can be reached.
std::optional<Target> ChooseStairFrontier(const Situation& now);

}  // namespace crossnav::agent::paper
