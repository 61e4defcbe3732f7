// SPDX-License-Identifier: MIT
// Settings of localisation in a saved map. Lengths in metres, angles in degrees. All values are
// chosen on generated houses 301 to 310 (docs/lifelong.md, "Awake and lost").
#pragma once

namespace crossnav::localization {

struct LocalizeConfig {
  // Search over places and headings.
  double place_step_m = 0.2;
  double yaw_step_deg = 5;
  double reach_m = 6;       ///< the search ignores points farther from the foot
  int search_points = 240;  ///< points that score a pose of the grid
  int hypotheses = 80;      ///< poses of the grid that are refined
  // Refinement and check of one hypothesis.
  int refine_points = 600;
  int kept = 12;             ///< hypotheses that are kept between attempts
  double slack_z_m = 0.15;   ///< tolerance of the foot's height over the map's ground
  double distinct_m = 0.6;   ///< hypotheses nearer than this and ...
  double distinct_deg = 20;  ///< ... with a smaller turn are the same
  // Decision: shares of the informative beams.
  double least_agreement = 0.8;  ///< of the best hypothesis
  double least_lead = 0.06;      ///< of the best over the second
  double least_share = 0.025;    ///< or: of the best over the second, where ...
  double least_sigmas = 8;       ///< ... the lead has this many standard deviations
  int least_beams = 40;          ///< fewer beams give no decision
  double pinned_m = 0.3;         ///< a shift by this length, or ...
  double pinned_deg = 6;         ///< ... a turn, must lower the score to ...
  double pinned_share = 0.95;    ///< ... this share of it
  // Motion.
  int attempt_every_turns = 3;  ///< turns in one field of view
  int action_budget = 150;      ///< afterwards the answer is "unknown"
};

}  // namespace crossnav::localization
