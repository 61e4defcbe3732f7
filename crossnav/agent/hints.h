// SPDX-License-Identifier: MIT
// Where the goal was seen too far away or too doubtfully to be claimed, or where it cannot be
// approached yet: worth going nearer to. World frame.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

/// Records a view of hint `poi_id` from where the agent stands. True where nothing decides about it
/// any more: neither a nearer view nor one from another side.
bool NoteLook(StepState& now, int poi_id);

/// The hints of one choice. Keeps references to the situation.
class Hints {
 public:
  explicit Hints(const Situation& now);

  /// Those that are seen from near for the first time, standing at `key`: a candidate each.
  std::vector<policy::Candidate> SeenFrom(const geometry::VoxelKey& key);

  /// Length of the straight line from `key` to the nearest hint of its storey that was not seen
  /// from near so far, nor approached in vain [m].
  std::optional<double> StraightTo(const geometry::VoxelKey& key) const;

 private:
  struct Hint {
    const policy::LivePoi& poi;
    policy::ViewTest view;
    const CloseLooks* looks = nullptr;  ///< null before the first
    bool was_approached = false;
    bool is_seen = false;
  };

  policy::ViewTest ViewWithin(double range_m, const policy::LivePoi& poi) const;
  policy::ViewTest ViewOf(const policy::LivePoi& poi, const CloseLooks* looks) const;
  bool IsView(const Hint& hint, const geometry::VoxelKey& key) const;
  bool HasView(const Hint& hint) const;

  const Situation& now_;
  std::vector<Hint> hints_;
};

}  // namespace crossnav::agent
