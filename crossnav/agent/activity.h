// SPDX-License-Identifier: MIT
// What the agent is doing, and what it has tried: one activity at a time, each with its target, its
// progress and the reason for which it ends; one record of attempts, from which everything that is
// not to be tried again follows. Plain data and the few questions asked of it. World frame, metres.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/policy/candidates.h"

namespace crossnav::agent {

enum class ActivityKind {
  kNone,
  kLookAround,  ///< a turn on the spot
  kGoTo,        ///< to a frontier, a sighting or uninspected ground
  kClimb,       ///< the same over stairs, towards another level
  kVisit,       ///< a remembered place
  kApproach,    ///< a live POI, with verification
};
std::string_view NameOf(ActivityKind kind);

/// Why an activity ended.
enum class Ending {
  kReached,      ///< there, and it was as hoped
  kGone,         ///< the target dissolved: seen, inspected, no frontier any more
  kSuperseded,   ///< something better was chosen
  kNotOpened,    ///< there, and looking at it changed nothing
  kNoProgress,   ///< the way did not get shorter for too long
  kUnreachable,  ///< no way any more
  kRefuted,      ///< verification failed
};
std::string_view NameOf(Ending ending);

struct Activity {
  ActivityKind kind = ActivityKind::kNone;
  policy::Candidate candidate;
  std::vector<geometry::VoxelKey> path;  ///< places to stand, the agent's first
  std::vector<Action> motion;            ///< what was planned along it, next action last
  double best_m = 1e9;                   ///< smallest remaining way so far
  int steps = 0;
  int idle_steps = 0;                 ///< since the remaining way last got shorter
  int looks = 0;                      ///< turns and pitches spent on looking at the target
  int replans = 0;                    ///< times the way got longer by what was seen of it
  bool is_path_closed = false;        ///< something that was seen since stands on it
  std::uint64_t ground_revision = 0;  ///< for which `path` was last found to hold
};

struct Attempt {
  policy::CandidateKind kind = policy::CandidateKind::kTraversableFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  Vector3d p_from_world = Vector3d::Zero();  ///< where the agent stood when it ended
  Ending ending = Ending::kReached;
  int step = 0;
};

inline bool IsExploring(const Activity& activity) {
  return activity.kind == ActivityKind::kGoTo || activity.kind == ActivityKind::kClimb;
}

/// Whether a target of `kind` about `p_focus_world` is not to be chosen again: it failed there, or
/// was chosen `max_choices` times without ever being settled.
bool IsSpent(const std::vector<Attempt>& attempts, policy::CandidateKind kind,
             const Vector3d& p_focus_world, double same_place_m, int max_choices);

}  // namespace crossnav::agent
