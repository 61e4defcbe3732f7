// SPDX-License-Identifier: MIT
// Where the goal was seen too far away or too doubtfully to be claimed, or where it cannot be
// approached yet: worth going nearer to. World frame.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"
#include "crossnav/policy/approach.h"

namespace crossnav::agent {

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
    bool was_approached = false;
    bool is_seen = false;
  };

  const Situation& now_;
  std::vector<Hint> hints_;
};

}  // namespace crossnav::agent
