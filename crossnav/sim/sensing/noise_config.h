// SPDX-License-Identifier: MIT
// Noise of the simulated sensors and wheels. All off by default; a profile or a single setting
// turns it on. Models: docs/noise.md.
#pragma once

#include <cstdint>
#include <string>

#include "crossnav/core/setting.h"

namespace crossnav::sim {

struct NoiseConfig {
  std::string profile = "none";  ///< none | realsense | kinect | spot; explicit settings win
  std::uint64_t seed = 1;        ///< together with the episode's id
  // Depth. Standard deviation at planar depth z: depth_sigma_m + depth_sigma_per_m2 * z^2 [m].
  double depth_sigma_m = 0;
  double depth_sigma_per_m2 = 0;
  double depth_step_per_m2 = 0;    ///< depths are multiples of this * z^2 [m]: steps of disparity
  double depth_shift_px = 0;       ///< std. dev. of the direction of a pixel: ragged edges
  double depth_edge_hole = 0;      ///< probability that a pixel beside a jump in depth is lost
  double depth_hole_share = 0;     ///< share of the picture that is lost in patches
  double depth_max_m = 0;          ///< beyond it there is no depth; 0 = no limit
  double depth_angle_sigma_m = 0;  ///< sigma grows by this * (a / (90 deg - a))^2 / sqrt(z) [m], a
                                   ///< = angle between ray and surface normal
  double depth_flying = 0;         ///< probability that a pixel beside a jump mixes both depths
  double depth_grazing_hole = 0;   ///< probability that a pixel is lost at 90 deg, from 60 deg on
  double depth_dark_hole = 0;      ///< probability that a black pixel is lost; none above 1/8 white
  double depth_glass_hole = 0;     ///< probability that a pixel of glass or a mirror is lost
  // Reported pose. Standard deviations per executed step.
  double drift_xy_m = 0;           ///< each horizontal axis, a move
  double drift_z_m = 0;            ///< a move
  double drift_yaw_deg = 0;        ///< a move or a turn
  int loop_closure_steps = 0;      ///< mean number of steps between two closures; 0 = never
  double loop_closure_gain = 0.8;  // chosen: share of the error that a closure takes back
  // Executed actions.
  double forward_sigma = 0;   ///< std. dev. of a move, as a share of its length
  double turn_sigma_deg = 0;  ///< std. dev. of a turn
  double slip = 0;            ///< probability that the wheels spin and a move leads nowhere
  // Frames.
  double drop = 0;            ///< probability that a frame is lost: no depth, black picture
  double exposure_stops = 0;  ///< std. dev. of the exposure of a frame, in powers of two
  double blur_px = 0;         ///< longest horizontal motion blur; a frame's is uniform in 0 to this
  double rolling_px = 0;      ///< farthest that rolling exposure moves the last row of colour to a
                              ///< side; a frame's is uniform up to this
};

template <class V>
void Visit(V& visit, NoiseConfig& c) {
  visit(CROSSNAV_SETTING(c, profile), {"none", "realsense", "kinect", "spot"});
  visit(CROSSNAV_SETTING(c, seed), std::uint64_t{0}, ~std::uint64_t{0});
  visit(CROSSNAV_SETTING(c, depth_sigma_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_sigma_per_m2), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_step_per_m2), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_shift_px), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, depth_edge_hole), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_hole_share), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_max_m), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, depth_angle_sigma_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_flying), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_grazing_hole), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_dark_hole), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, depth_glass_hole), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, drift_xy_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, drift_z_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, drift_yaw_deg), 0.0, 90.0);
  visit(CROSSNAV_SETTING(c, loop_closure_steps), 0, 1000000);
  visit(CROSSNAV_SETTING(c, loop_closure_gain), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, forward_sigma), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, turn_sigma_deg), 0.0, 90.0);
  visit(CROSSNAV_SETTING(c, slip), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, drop), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, exposure_stops), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, blur_px), 0.0, 200.0);
  visit(CROSSNAV_SETTING(c, rolling_px), 0.0, 200.0);
}

/// Settings of `profile`, with the default seed; of "none" for unknown names.
NoiseConfig NoiseOfProfile(const std::string& profile);

}  // namespace crossnav::sim
