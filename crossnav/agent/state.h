// SPDX-License-Identifier: MIT
// State of the agent in two structs: World lives as long as the episode, GoalState starts anew with
// every goal (paper, "Experimental Configuration" in the supplement). Each has a part that both
// profiles share and a part for either profile (policy.profile). Plain data.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "crossnav/agent/activity.h"
#include "crossnav/agent/config.h"
#include "crossnav/agent/described_goal.h"
#include "crossnav/agent/pictured_goal.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/objects/object_book.h"
#include "crossnav/objects/room_odds.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/coverage.h"
#include "crossnav/policy/flight_survey.h"
#include "crossnav/policy/frontier_worth.h"
#include "crossnav/policy/glance.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/policy/modes.h"
#include "crossnav/policy/onemap_goals.h"
#include "crossnav/policy/search_field.h"
#include "crossnav/policy/stair_evidence.h"
#include "crossnav/policy/stair_session.h"
#include "crossnav/policy/steering.h"
#include "crossnav/policy/unanswered_ground.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::agent {

/// World state of policy.profile = full.
struct FullWorld {
  policy::LookedAlong looked_along;           ///< headings of the frames so far, by place
  std::vector<double> looked_around_m;        ///< heights at which a full turn was made
  std::vector<double> levels_with_descent_m;  ///< levels from which stairs down were seen
  policy::UnansweredGround unanswered;        ///< looked at from near in vain
  std::optional<AgentPose> before_forward;    ///< pose before the last forward step
  int flat_frames = 0;  ///< consecutive frames on flat ground off the exploration level
  policy::SearchField field;
  double confirmed_similarity = -1;          ///< lowest of a confirmed object and its goal's text
  std::vector<policy::NamedText> names;      ///< rival names of claims, verify.memory = on
  std::vector<float> door;                   ///< text of a door, with a loaded memory
  std::set<std::string> asked;               ///< goals so far, as the detector was asked
  std::set<std::string> unknown_names;       ///< that the detector does not know; spaced
  std::set<std::string> noticed_throughout;  ///< asked for since the first frame; spaced
};

/// World state of policy.profile = paper.
struct PaperWorld {
  policy::BumpMonitor bumps;
  int last_direction = 0;  ///< of the last successful floor transition; 0 = none yet
};

/// World state of policy.profile = onemap.
struct OneMapWorld {
  policy::OneMapMap map;
  std::set<policy::Column> blacklist;  ///< goals that did not go away when they were reached
};

/// A loaded memory under memory.mode = revise: the rooms that it knows.
struct Revision {
  scenegraph::SceneGraph loaded;          ///< of the map as it was loaded
  scenegraph::SceneGraph graph;           ///< of the map now, with the rooms that today has shown
  std::vector<objects::RoomPlace> rooms;  ///< of `graph`
  std::int64_t known_voxels = 0;          ///< of the map when `graph` was made
};

/// Survives a change of goal.
struct World {
  geometry::VoxelMap map;
  planner::GroundMap ground;
  memory::SemanticMemory memory;
  policy::StairEvidence stairs;
  policy::Coverage coverage;  ///< inspected ground; cleared by goals per poi.keep_coverage
  std::vector<geometry::StairFlight> flights;  ///< walked flights first
  policy::FlightSurvey flight_survey;
  std::vector<Vector3d> path_off_level_world;  ///< foot positions since the level was left
  double level_m = 0;                          ///< height of the exploration level
  bool has_level = false;
  int step = 0;
  std::vector<double> levels_m;                ///< heights of the levels that were stood on
  std::vector<geometry::StateChange> changes;  ///< of this step
  FullWorld full;
  PaperWorld paper;
  OneMapWorld onemap;
  objects::ObjectBook objects;
  int day = 0;                       ///< runs with the loaded memory before this one
  bool has_loaded_objects = false;   ///< records of an earlier run
  std::optional<Revision> revision;  ///< empty: no memory was loaded, or memory.mode = keep

  /// Brings states and ground up to date with the evidence.
  void UpdateStates() {
    const auto& fresh = map.UpdateStates();
    changes.insert(changes.end(), fresh.begin(), fresh.end());
    ground.Update(fresh);
  }

  /// The map's settings; the paper's map ends at its box.
  static geometry::MapConfig MapConfigOf(const Config& config) {
    geometry::MapConfig map = config.map;
    map.clip_to_extent |= config.policy.profile == "paper";
    return map;
  }

  explicit World(const Config& config)
      : map(MapConfigOf(config)),
        ground(config.map),
        memory(config.fusion, config.map.voxel_m),
        objects(config.map.voxel_m) {}
};

/// A place of the memory that answered the goal's query.
struct HistoryPoi {
  std::vector<geometry::VoxelKey> voxels;
  Vector3d p_center_world = Vector3d::Zero();
  double score = 0;
  double similarity = 0;  ///< mean cosine of its best quarter [-1, 1]
  double belief = 1;      ///< probability that the object is there, under memory.mode = revise
  std::vector<Vector3d> p_looked_world;  ///< feet of the looks on arrival that were in vain
  bool is_exhausted = false;
  std::optional<int> unreachable_step;  ///< last step at which no path to a view of it was found
  int looked = 0;                       ///< frames spent looking at it on arrival
};

/// Views of a hint or live POI with too low confidence: the next view is nearer while the
/// confidence rises, then from another side.
struct CloseLooks {
  int poi_id = -1;
  std::vector<Vector3d> p_from_world;  ///< foot positions of the views so far
  double confidence = 0;               ///< best after the last view
  double distance_m = 0;               ///< of the last view that raised it; 0 = none did
  int without_rise = 0;                ///< views in a row that did not raise the confidence
};

/// Views of one live POI that verification failed from.
struct FailedViews {
  int poi_id = -1;
  std::vector<Vector3d> p_from_world;
  int count = 0;
  double doubtful_m = 0;  ///< FullGoal::doubtful_m after the last
};

/// Search of a known house for a goal that is at no place that the memory believes.
struct ObjectSearch {
  std::map<int, double> odds;                   ///< by room of the graph; empty = all ground alike
  std::map<geometry::VoxelKey, double> shares;  ///< probability of each patch, in sum 1
  std::set<geometry::VoxelKey> hidden;          ///< patches that no place shows
  std::set<geometry::VoxelKey> settled;         ///< patches of views that were taken
  bool was_noticed = false;                     ///< every frame of the run looked for the goal
  bool is_tall = false;                         ///< it reaches the high points of the patches
  bool is_wide = false;                         ///< it reaches into the next patch
  double notice_range_m = 0;                    ///< up to which a look finds the goal in most cases
  double sure_range_m = 0;                      ///< up to which it finds the goal
  double missed = 0;  ///< chance that a look between both ranges misses it
  double unseen = 1;  ///< probability that the goal is at a patch and was not noticed
  int step = -1;      ///< of the last refresh of `shares` and `unseen`
};

/// Goal state of policy.profile = full.
struct FullGoal {
  Activity activity;
  std::vector<Attempt> attempts;    ///< pursuits that ended
  policy::LivePois hints;           ///< sightings too weak for a live POI
  std::vector<CloseLooks> looks;    ///< at hints
  policy::ClaimTracker hint_views;  ///< of hints in plain sight, verify.evidence = views
  std::vector<FailedViews> failed;  ///< of live POIs other than the active POI
  double doubtful_m = 0;         ///< distance of the last view of the active live POI that was too
                                 ///< little for its confidence; 0 = none was
  policy::ClaimTracker claims;   ///< verify.memory = on
  std::size_t last_resorts = 0;  ///< last resorts used up
  std::size_t ways_tried = 0;    ///< ways to open the way to a steady sight, used up
  std::optional<Vector3d> p_unmarked_world;  ///< foot where marks of bumps were forgotten last
  bool may_squeeze = false;                  ///< planner rules that last resorts relaxed
  bool may_step_on_seats = false;
  double inspect_range_m = 0;
  policy::Relevancy relevancy;         ///< scoring = semantic
  int relevancy_step = -1;             ///< step of its last refresh
  std::optional<ObjectSearch> search;  ///< memory.mode = revise, or the last resort
};

/// Verification of a stair entrance, while the agent stands there and looks.
struct EntranceCheck {
  policy::CandidateKind kind = policy::CandidateKind::kDescendFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  int frames = 0;
  int looks = 0;  ///< pitch actions spent
};

/// The exploration target of the literal method.
struct Commitment {
  policy::CandidateKind kind = policy::CandidateKind::kTraversableFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  std::vector<geometry::VoxelKey> standing;
  int since_step = 0;
  int arrived_looks = 0;
};

/// Goal state of policy.profile = paper.
struct PaperGoal {
  policy::Mode mode = policy::Mode::kBasicExplore;
  bool is_new = true;
  int active_history = -1;                                   ///< index into `history`, -1 = none
  std::vector<policy::BlacklistedPlace> blacklist;           ///< POIs
  std::vector<policy::BlacklistedPlace> frontier_blacklist;  ///< frontiers that did not open up
  std::vector<policy::BlacklistedPlace> set_aside;           ///< rejected stair entrances
  bool is_detection_rejected = false;  ///< verification of the approached POI failed last step
  std::optional<Commitment> commitment;
  std::optional<EntranceCheck> entrance;
  std::optional<policy::StairSession> session;
  int steps_without_stair_target = 0;
  double scanned_landing_m = -1e9;  ///< height of the landing of the last full turn
  std::deque<Action> script;        ///< actions of a full turn or of an escape from a bump
  bool is_relaxed = false;          ///< the relaxed retry was used
};

/// The object that OneMap goes to.
struct OneMapObject {
  policy::Column column;
  Vector3d p_world = Vector3d::Zero();
};

/// Goal state of policy.profile = onemap.
struct OneMapGoalState {
  std::optional<OneMapObject> object;
  std::optional<policy::OneMapGoal> last;  ///< the frontier or point of interest gone to
  std::set<policy::Column> unreachable;    ///< objects without a path
  int stuck_steps = 0;                     ///< at the end of the path to it
};

/// Live POIs under a goal that means one instance.
struct InstanceChoice {
  bool takes_guesses = false;  ///< nothing is left to explore
  std::set<int> set_aside;     ///< ids of live POIs that do not fit
};

/// Reinitialised by every new goal.
struct GoalState {
  std::string goal;                        ///< name of a category or an object
  std::optional<DescribedGoal> described;  ///< more was said than the name
  std::optional<PicturedGoal> pictured;    ///< the goal is a picture
  InstanceChoice instances;                ///< of a goal that is described or pictured
  int index = -1;
  int begun_step = 0;  ///< of the world, when the goal was set
  std::vector<float> text;
  std::vector<std::vector<float>> background;  ///< text vectors for query.relevancy = contrastive
  policy::LivePois live;
  std::vector<HistoryPoi> history;
  int active_live = -1;  ///< id of the POI being approached, -1 = none
  std::vector<Vector3d> tried_viewpoints;
  int failed_views = 0;
  Vector3d p_looked_around_world =
      Vector3d::Constant(1e9);      ///< foot position of the last full turn
  std::vector<std::string> events;  ///< of this step
  FullGoal full;
  PaperGoal paper;
  OneMapGoalState onemap;
};

}  // namespace crossnav::agent
