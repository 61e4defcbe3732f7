// SPDX-License-Identifier: MIT
// The activity of the agent as a variant, and the record of attempts. An activity is a pursuit of
// one target, or a scan on the spot that interrupts a pursuit. Every pursuit measures its progress
// and ends with a reason. Plain data and queries. World frame, metres.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/policy/candidates.h"

namespace crossnav::agent {

/// Reason for the end of a pursuit.
enum class Ending {
  kReached,      ///< arrived, with success
  kUndecided,    ///< arrived at a hint that another view may decide
  kGone,         ///< the target dissolved: seen, inspected, no frontier any more
  kSuperseded,   ///< a better target was chosen
  kNotOpened,    ///< arrived, and looking at the target changed nothing
  kNoProgress,   ///< the path did not get shorter for too long
  kUnreachable,  ///< no path any more
  kRefuted,      ///< verification failed
};
std::string_view NameOf(Ending ending);

/// Path to a target and the progress along it.
struct Route {
  std::vector<geometry::VoxelKey> path;  ///< places to stand, the agent's first
  std::vector<Action> motion;            ///< actions planned along the path, next action last
  double best_m = 1e9;                   ///< smallest remaining path length so far
  int steps = 0;
  int idle_steps = 0;                 ///< since the remaining path last got shorter
  int replans = 0;                    ///< longer paths that new observations explain
  bool is_closed = false;             ///< a later observation closed a step of the path
  std::uint64_t ground_revision = 0;  ///< revision at which `path` was last found open
};

/// Members that all pursuits but Idle share.
struct Pursued {
  policy::Candidate target;
  Route route;
  int looks = 0;  ///< turns and pitches spent on looking at the target
};

struct Idle {};
/// To a frontier, a hint or uninspected ground.
struct GoTo : Pursued {};
/// The same over stairs, towards another level.
struct Climb : Pursued {};
/// To a remembered place.
struct VisitPlace : Pursued {
  int place = -1;  ///< index into GoalState::history
};
/// To a live POI, with verification.
struct Approach : Pursued {
  int poi_id = -1;
};
using Pursuit = std::variant<Idle, GoTo, Climb, VisitPlace, Approach>;

/// Turns on the spot. The pursuit that a scan interrupts goes on afterwards.
struct Scan {
  std::deque<Action> turns;  ///< never empty; of an escape, with a step after each turn
  Pursuit suspended;
  std::optional<Vector3d>
      p_escape_world;  ///< of an escape: it ends where the body is off this foot
};
using Activity = std::variant<Pursuit, Scan>;

/// The pursuit in progress, or the pursuit that a scan interrupts.
Pursuit& PursuitOf(Activity& activity);
const Pursuit& PursuitOf(const Activity& activity);
/// Target and route of a pursuit; null while idle.
Pursued* PursuedIn(Pursuit& pursuit);
const Pursued* PursuedIn(const Pursuit& pursuit);

bool IsScanning(const Activity& activity);
/// Whether the pursuit explores: GoTo or Climb.
bool IsExploring(const Pursuit& pursuit);

/// Name in traces: none, look_around, go_to, climb, visit, approach.
std::string_view NameOf(const Activity& activity);
std::string_view NameOf(const Pursuit& pursuit);

struct Attempt {
  policy::CandidateKind kind = policy::CandidateKind::kTraversableFrontier;
  Vector3d p_focus_world = Vector3d::Zero();
  Vector3d p_from_world = Vector3d::Zero();  ///< the agent's foot when the pursuit ended
  Ending ending = Ending::kReached;
  int step = 0;
};

/// Whether a target of `kind` about `p_focus_world` is not to be chosen again: it failed there, or
/// was chosen `max_choices` times without ever being settled.
bool IsSpent(const std::vector<Attempt>& attempts, policy::CandidateKind kind,
             const Vector3d& p_focus_world, double same_place_m, int max_choices);

}  // namespace crossnav::agent
