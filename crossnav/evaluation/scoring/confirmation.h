// SPDX-License-Identifier: MIT
// The agent's detection rule, applied to an instance before an episode: would a robot at this place
// confirm it? Rule: ground truth's detection (crossnav/sim/sensing/ground_truth.h) lifted to
// voxels, kept as a live POI and verified (crossnav/policy/live_poi.h, approach.h), with the
// settings of the run: box >= 1/64 of the picture, >= 10 voxels, confidence >= 0.70, within 1.30 m.
// Certificates of edition 2 use it. World frame, metres.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::evaluation {

class ConfirmationRule {
 public:
  /// Keeps references.
  ConfirmationRule(const sim::RayCaster& caster, const sim::SceneInstance& instance,
                   const RunConfig& config)
      : caster_(caster), instance_(instance), config_(config) {}

  /// True if the rule confirms the instance from `p_foot`, facing it as exactly as turns of
  /// action.turn_deg allow: half a turn step to the left and half a step to the right of it.
  bool IsConfirmedFrom(const Vector3d& p_foot) const;

  /// The point nearest to the instance's box that confirms it; empty if none does. Tries points 0.2
  /// m apart, nearest first.
  std::optional<Vector3d> FirstOf(std::vector<Vector3d> points) const;

 private:
  bool IsConfirmedAt(const AgentPose& pose) const;

  const sim::RayCaster& caster_;
  const sim::SceneInstance& instance_;
  const RunConfig& config_;
};

}  // namespace crossnav::evaluation
