// SPDX-License-Identifier: MIT
// One probability that an object is the goal, from all views of it: the score of its best view, and
// the scores of the others, 0 where the detector missed it in plain sight. World frame, metres.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/core/pose.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::policy {

/// Settings `verify.*` of the fusion; measured by benchmarks/detector_calibration.cpp
/// (docs/networks.md, "Scores as probabilities").
struct EvidenceConfig {
  double offset = 0;  ///< log-odds of an object with one view = offset + slope x those of its score
  double slope = 1;   ///< likewise
  double missed = -1;           // chosen: added log-odds of another view without a detection
  double found = 1;             // chosen: and of another view with a score of 1; linear in between
  double too_short = 0;         ///< added log-odds of an object that is too short for the goal
  double discount = 0.5;        // chosen: what each further view is worth of the one before
  double decided = 0.9;         // chosen: probability from which an object is the goal
  double decided_alone = 0.97;  // chosen: and from one side only
  double refused = 0.5;         // chosen: and below which, seen from two sides, it is not
};

/// Frames from about one place. A frame without a detection says little beside others with one: the
/// object may be cut by the image's edge.
struct ViewScore {
  Vector3d p_camera_world = Vector3d::Zero();
  double sum = 0;           ///< of scores
  int frames = 0;           ///< with a detection; 0 = it was missed from here
  int missed_frames = 0;    ///< in plain sight without a detection
  double sum_length_m = 0;  ///< over frames in which no side of the image cuts it
  int uncut_frames = 0;
  double Length_m() const { return uncut_frames > 0 ? sum_length_m / uncut_frames : 0; }
  double Mean() const { return frames > 0 ? sum / frames : 0; }
};

/// Log-odds of one score in [0, 1].
double LogOddsOf(double score);

/// The best view, and the others: the sum of their discounts, and the mean of their scores.
struct ViewSummary {
  int views = 0;
  double best_log_odds = 0;
  double others = 0;
  double mean = 0;
  double shortness = 0;  ///< of the object, for the goal (goal_length.h)
};
/// `goal`: as CanonicalName gives it.
ViewSummary SummaryOf(const std::vector<ViewScore>& views, std::string_view goal, double discount);

/// Probability that the object is the goal. 0.5 without views.
double ProbabilityOf(const ViewSummary& views, const EvidenceConfig& config);

/// How a frame shows an object, by its voxels.
struct Sight {
  double range_m = 0;  ///< from the camera to the mean of its voxels
  double framed = 0;   ///< share of its voxels inside the image
  double shown = 0;    ///< share of its voxels whose distance the depth image has
};
Sight SightOf(const std::vector<geometry::VoxelKey>& voxels, const Observation& obs,
              double voxel_m);

/// Near but not too near, framed and not hidden: a detector without a detection there has missed
/// the object.
bool IsPlain(const Sight& sight);

}  // namespace crossnav::policy
