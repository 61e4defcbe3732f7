// SPDX-License-Identifier: MIT
// Furniture that carries things, learned from the records: in many houses nothing stands on a bed,
// whose top is the largest. World frame, metres.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "crossnav/agent/state.h"

namespace crossnav::agent {

/// Keeps references to the records of the world.
class Carriers {
 public:
  explicit Carriers(const World& world);

  /// P(a thing stands on furniture of the kind that is at `p_top_world`) over the share of such
  /// tops in all tops; 1 = as likely as its area says.
  double WeightAt(const Vector3d& p_top_world) const;

 private:
  /// Category of the furniture on record that the point is on; empty = none on record.
  std::string KindAt(const Vector3d& p_top_world) const;
  std::vector<Vector3d> FeetOfThingsOnTops(const World& world) const;

  double voxel_m_;
  std::vector<const objects::ObjectRecord*> furniture_;
  std::map<std::string, double> weights_;  // by category
};

}  // namespace crossnav::agent
