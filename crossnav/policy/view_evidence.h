// SPDX-License-Identifier: MIT
// One probability that an object is the goal, from all its sightings: calibrated scores as
// log-odds, near-identical views counted once, other views at a discount since they see the same
// thing. World frame, metres.
#pragma once

#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::policy {

/// Settings `verify.*` of the fusion; measured by benchmarks/detector_calibration.cpp
/// (docs/networks.md, "Scores as probabilities").
struct EvidenceConfig {
  double offset = 0;  ///< log-odds that a sighting is true = offset + slope x log-odds of its score
  double slope = 1;   ///< likewise
  double discount = 0.5;  // chosen: what each further view is worth of the one before
  double decided = 0.9;   // chosen: probability from which an object is the goal
  double refused = 0.3;   // chosen: and below which, seen from two sides, it is not
};

/// Frames from about one place.
struct ViewScore {
  Vector3d p_camera_world = Vector3d::Zero();
  double sum = 0;  ///< of calibrated log-odds
  int frames = 0;
  double Mean() const { return sum / frames; }
};

/// Calibrated log-odds of one score in [0, 1].
double LogOddsOf(double score, const EvidenceConfig& config);

/// Probability that the object is the goal: views by the size of their mean log-odds, each worth
/// `discount` of the one before. 0.5 without views.
double ProbabilityOf(const std::vector<ViewScore>& views, const EvidenceConfig& config);

}  // namespace crossnav::policy
