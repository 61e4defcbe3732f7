// SPDX-License-Identifier: MIT
// Where to stand to look at an object or at a remembered place, over the ground of all floors.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/planner/ground_search.h"

namespace crossnav::agent {

/// A candidate with its path.
struct GroundTarget {
  policy::Candidate candidate;
  std::vector<geometry::VoxelKey> path;
  double cost_m = 0;
  double score_m = 0;  ///< path cost plus price of the class; lower is better
};

/// Walkable ground: every floor, or the start level alone for the planar variant.
planner::GroundRules RulesOf(const Situation& now);

/// Foot position of an agent at a place to stand.
Vector3d FootOf(const geometry::VoxelKey& key, double voxel_m);

/// Whether an object at this height above an agent's foot is on the storey of the agent.
bool IsOnStorey(double above_foot_m, const policy::ExploreConfig& config);

/// Whether an agent's foot is on the storey of an object: no higher than the ground beside the
/// object, where that is known. The treads of a flight are near the objects beside it, too.
class ObjectStorey {
 public:
  ObjectStorey(const Situation& now, const std::vector<geometry::VoxelKey>& object,
               const Vector3d& p_center_world);
  bool Has(const Vector3d& p_foot_world) const;

 private:
  double center_m_;
  std::optional<double> ground_m_;
  policy::ExploreConfig config_;
};

/// Ranges of a view that follows one from `distance_m` without enough confidence, as shares of it,
/// in order of preference: almost three times the pixels, down to a fifth more.
inline constexpr std::array kNearerShares = {0.6, 0.7, 0.8, 0.9};  // chosen

/// A place to look at something from.
struct ViewWish {
  const std::vector<geometry::VoxelKey>& object;
  double range_m = 0;                   ///< within which enough of it must be in view
  std::vector<Vector3d> tried{};        ///< places not to offer again
  std::vector<Vector3d> other_sides{};  ///< of `p_center_world` than these cameras', if any
  Vector3d p_center_world = Vector3d::Zero();
  bool is_on_storey = false;            ///< only from the storey of `p_center_world`
  std::optional<Vector3d> same_side{};  ///< only about where this camera saw it from
  double side_share = 1;             ///< of verify.view_angle_deg, within which a side is the same
  bool is_through_seen_air = false;  ///< only where no unobserved space may hide it
};

/// The nearest place that fulfils `wish`.
std::optional<GroundTarget> NearestView(const Situation& now, const geometry::VoxelKey& start,
                                        const ViewWish& wish);

/// The nearest untried place with a view of `poi`; on another side where a second view is
/// required, and about the best view where the agent comes back to it.
std::optional<GroundTarget> ViewOf(const Situation& now, const geometry::VoxelKey& start,
                                   const policy::LivePoi& poi);

/// The views of a live POI that failed so far, the active one's or another's.
FailedViews FailedViewsOf(const GoalState& goal, int poi_id);

/// The best live POI that can be approached.
std::optional<GroundTarget> ChooseLivePoi(const Situation& now, const geometry::VoxelKey& start);

/// Whether a remembered place is to be visited where a path leads there: it is not settled, was not
/// tried too often, and answers as strongly as a thing that was found, or stands out.
bool IsWorthGoingTo(const Situation& now, const HistoryPoi& poi);

/// Whether a remembered place may be visited now or later: it is worth going to, and was not found
/// to be out of reach.
bool IsToBeVisited(const Situation& now, const HistoryPoi& poi);

/// Whether the place, looked at in vain from the views so far, is to be seen from another side and
/// can be: its record is believed, or it answers well and the goal has no record.
bool HasOtherSide(const Situation& now, const HistoryPoi& poi);

struct PlaceChoice {
  std::optional<GroundTarget> target;
  int place = -1;  ///< index into GoalState::history
  /// HistoryPoi::unreachable_step of each place after the searches of this choice.
  std::vector<std::optional<int>> unreachable_steps;
};
/// The remembered place to visit next.
PlaceChoice ChooseHistoryPoi(const Situation& now, const geometry::VoxelKey& start);

}  // namespace crossnav::agent
