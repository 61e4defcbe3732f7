// SPDX-License-Identifier: MIT
// What the agent remembers, in two structs: what lives as long as the episode, and what a new goal
// starts anew (paper, "Experimental Configuration" in the supplement). Plain data.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/activity.h"
#include "crossnav/agent/config.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/coverage.h"
#include "crossnav/policy/flight_survey.h"
#include "crossnav/policy/frontier_worth.h"
#include "crossnav/policy/glance.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/policy/modes.h"
#include "crossnav/policy/stair_evidence.h"
#include "crossnav/policy/stair_session.h"
#include "crossnav/policy/steering.h"

namespace crossnav::agent {

/// Survives a change of goal.
struct World {
  geometry::VoxelMap map;
  planner::GroundMap ground;
  memory::SemanticMemory memory;
  policy::StairEvidence stairs;
  policy::Coverage coverage;  ///< what was seen from near; without history POIs, for this goal
  std::vector<geometry::StairFlight> flights;  ///< walked ones first
  policy::FlightSurvey flight_survey;
  std::vector<Vector3d> way_off_level_world;  ///< foot positions since the level was left
  double level_m = 0;                         ///< height of the exploration level
  bool has_level = false;
  int step = 0;
  int last_direction = 0;  ///< of the last successful floor transition; 0 = none yet
  int flat_frames = 0;     ///< consecutive frames on flat ground off the exploration level
  double confirmed_similarity = -1;     ///< lowest of an object that was found and its goal's text
  std::vector<double> levels_m;         ///< heights of the levels that were stood on
  std::vector<double> upper_levels_m;   ///< heights of the levels from which stairs down were seen
  policy::LookedAlong looked_along;     ///< pictures so far
  std::vector<double> looked_around_m;  ///< heights at which a look around was made
  std::optional<AgentPose> before_forward;  ///< pose before the last forward step
  policy::BumpMonitor bumps;                ///< policy.profile = paper

  std::vector<policy::NamedText> names;        ///< that claims are held against, verify.memory = on
  std::vector<geometry::StateChange> changes;  ///< of this step

  /// Brings states and ground up to date with the evidence.
  void UpdateStates() {
    const auto& fresh = map.UpdateStates();
    changes.insert(changes.end(), fresh.begin(), fresh.end());
    ground.Update(fresh);
  }

  explicit World(const Config& config)
      : map(config.map), ground(config.map), memory(config.fusion, config.map.voxel_m) {}
};

/// A place of the memory that answered the goal's query.
struct HistoryPoi {
  std::vector<geometry::VoxelKey> voxels;
  Vector3d p_center_world = Vector3d::Zero();
  double score = 0;
  double similarity = 0;  ///< mean cosine of its best quarter [-1, 1]
  bool is_exhausted = false;
  std::optional<int> unreachable_step;  ///< in which no way to a view of it was found last
  int looked = 0;                       ///< frames spent looking at it on arrival
};

/// Verification of a stair entrance, while the agent stands there and looks.
struct EntranceCheck {
  policy::CandidateKind kind = policy::CandidateKind::kDescendFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  int frames = 0;
  int looks = 0;  ///< pitch actions spent
};

/// The exploration target being followed.
struct Commitment {
  policy::CandidateKind kind = policy::CandidateKind::kTraversableFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  std::vector<geometry::VoxelKey> standing;
  int since_step = 0;
  int arrived_looks = 0;
};

/// Reinitialised by every new goal.
struct GoalState {
  std::string goal;
  int index = -1;
  std::vector<float> text;
  std::vector<std::vector<float>> background;  ///< text vectors for query.relevancy = contrastive
  policy::Mode mode = policy::Mode::kBasicExplore;
  bool is_new = true;
  policy::LivePois live;
  std::vector<HistoryPoi> history;
  int active_history = -1;  ///< index into `history`, -1 = none
  int active_live = -1;     ///< id of the POI being approached, -1 = none
  std::vector<Vector3d> tried_viewpoints;
  int failed_views = 0;

  // policy.profile = paper
  std::vector<policy::BlacklistedPlace> blacklist;           ///< POIs
  std::vector<policy::BlacklistedPlace> frontier_blacklist;  ///< frontiers that did not open up
  std::vector<policy::BlacklistedPlace> set_aside;           ///< rejected stair entrances
  std::optional<Commitment> commitment;
  std::optional<EntranceCheck> entrance;
  std::optional<policy::StairSession> session;
  int steps_without_stair_target = 0;
  double scanned_landing_m = -1e9;  ///< height of the landing that was looked around on
  std::deque<Action> script;        ///< a look around, a correction of pitch
  Vector3d p_looked_around_world = Vector3d::Constant(1e9);
  bool is_relaxed = false;          ///< the one relaxed retry was used
  std::vector<std::string> events;  ///< of this step

  // policy.profile = full
  Activity activity;
  std::vector<Attempt> attempts;  ///< everything that was tried and ended
  policy::LivePois hints;         ///< sightings too weak for a live POI
  policy::ClaimBook claims;       ///< verify.memory = on
  int last_resorts = 0;           ///< of the things to try when nothing is left, how many were used
  double inspect_range_m = 0;
  policy::Resemblance resemblance;  ///< scoring = semantic
  int resemblance_step = -1;        ///< in which it was refreshed last
};

}  // namespace crossnav::agent
