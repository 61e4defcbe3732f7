// SPDX-License-Identifier: MIT
// Trace of a step, as plain data: the only input of viewers and logs. World frame, metres. Timings
// are separate (StepTiming), so that the same seed gives the same trace, byte for byte.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/box.h"
#include "crossnav/core/pose.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::trace {

struct CandidateTrace {
  std::string kind;  ///< live_poi, history_poi, traversable_frontier, descend_frontier, ...
  Vector3d p_nav_world = Vector3d::Zero();    ///< standing place
  Vector3d p_focus_world = Vector3d::Zero();  ///< focus, e.g. centre of the cluster
  double score = 0;
  double path_cost = -1;  ///< [voxels], -1 = not planned
  int size = 0;           ///< [voxels]
  bool is_reachable = true;
  bool is_target = false;
};

struct VerificationTrace {
  bool is_active = false;
  bool passed = false;
  double confidence = 0, mask_quality = 0, visibility = 0, view_angle_deg = 0, distance_m = 0;
  std::string failed_check;  ///< empty when passed or inactive
};

/// The semantic memory after the step.
struct MemoryTrace {
  std::int64_t rows = 0;            ///< feature-bearing voxels
  std::int64_t compacted_rows = 0;  ///< of these: int8 under fusion.max_rows
  std::int64_t dropped_rows = 0;    ///< dropped under fusion.max_rows so far
};

struct StepTrace {
  int step = 0;        ///< within the episode, from 0
  int goal_index = 0;  ///< from 0
  std::string goal;
  AgentPose agent;
  Pose T_world_camera = Pose::Identity();
  Action action = Action::kStop;
  std::string mode;    ///< basic_explore, stair_explore, poi_navigation, target_approach
  std::string reason;  ///< reason of the mode
  /// none, look_around, go_to, climb, visit, approach; empty under policy.profile = paper
  std::string activity;
  std::vector<CandidateTrace> candidates;  ///< best first within each class
  std::vector<Vector3d> path_world;        ///< planned, from the agent to the target
  VerificationTrace verification;
  /// Known flights, in steps in which a flight changed; else empty.
  std::optional<std::vector<geometry::StairFlight>> flights;
  std::vector<std::string> events;  ///< e.g. "goal activated: bed", "entrance rejected"
  double level_m = 0;               ///< height of the current exploration level
  std::vector<geometry::StateChange> voxel_changes;  ///< sorted by key
  bool all_explored = false;
  int detections = 0;
  MemoryTrace memory;
};

/// CPU time of each stage of one step [ms], in order; separate from StepTrace for determinism.
struct StageTime {
  std::string stage;
  double ms = 0;
};

}  // namespace crossnav::trace
