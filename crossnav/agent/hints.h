// SPDX-License-Identifier: MIT
// Where the goal was seen too far away or too doubtfully to be claimed, or where it cannot be
// approached yet: worth going nearer to. World frame.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

/// Records a view of hint `poi_id` from where the agent stands. True where no further view can
/// decide: neither from nearer nor from another side.
bool NoteLook(StepState& now, int poi_id);

/// Whether a place in reach shows the hint from near, from where it was not looked at yet.
bool IsSeenFromReach(const Situation& now, int poi_id);

/// The hints of one choice. Keeps references to the situation.
class Hints {
 public:
  explicit Hints(const Situation& now);

  struct View {
    policy::Candidate candidate;
    bool is_nearer = true;  ///< than the last view; false: as far away, from another side
  };
  /// Hints seen from near for the first time, from `key`: a view each.
  std::vector<View> SeenFrom(const geometry::VoxelKey& key);

  /// Length of the straight line from `key` to the nearest hint of its storey that was not seen
  /// from near so far, nor approached in vain [m].
  std::optional<double> StraightTo(const geometry::VoxelKey& key) const;

  bool empty() const { return hints_.empty(); }

 private:
  struct Hint {
    const policy::LivePoi& poi;
    policy::ViewTest view;                   ///< within the approach range
    std::optional<policy::ViewTest> nearer;  ///< nearer than the last view, if such a place exists
    const CloseLooks* looks = nullptr;       ///< null before the first
    bool was_approached = false;
    bool is_seen = false, is_seen_nearer = false;
  };

  policy::ViewTest ViewWithin(double range_m, const policy::LivePoi& poi) const;
  std::optional<policy::ViewTest> NearerView(const policy::LivePoi& poi,
                                             const CloseLooks* looks) const;
  bool HasView(const policy::ViewTest& view, const CloseLooks* looks) const;

  double voxel_m() const { return now_.config.map.voxel_m; }

  const Situation& now_;
  std::vector<Hint> hints_;
};

}  // namespace crossnav::agent
