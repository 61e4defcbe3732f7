// SPDX-License-Identifier: MIT
// The profiles of sensors, each setting once; docs/noise.md has the sources.
#include <array>
#include <utility>

#include "crossnav/sim/sensing/noise_config.h"

namespace crossnav::sim {
namespace {

/// The settings that differ from profile to profile, one line each, in the order of kProfiles.
struct Row {
  double NoiseConfig::*setting;
  std::array<double, 3> values;
};
constexpr std::array<const char*, 3> kProfiles = {"realsense", "kinect", "spot"};

// chosen: realsense is sub-pixel stereo, 1.5 % at 2 m, with visual-inertial odometry of about 1 %
// of the path; kinect structured light, 14 mm at 3 m (Nguyen et al. 2012), steps of 1/8 px of
// disparity; spot stereo of a walking robot, short range and shaken, whose legs drift more than
// wheels.
constexpr Row kRows[] = {
    {&NoiseConfig::depth_sigma_m, {0.001, 0.0012, 0.002}},
    {&NoiseConfig::depth_sigma_per_m2, {0.0037, 0.00142, 0.005}},
    {&NoiseConfig::depth_shift_px, {0.5, 0.5, 0.7}},
    {&NoiseConfig::depth_edge_hole, {0.3, 0.5, 0.5}},
    {&NoiseConfig::depth_hole_share, {0.02, 0.03, 0.05}},
    {&NoiseConfig::depth_max_m, {8, 5, 4}},
    {&NoiseConfig::drift_xy_m, {0.003, 0.005, 0.006}},
    {&NoiseConfig::drift_z_m, {0.001, 0.001, 0.003}},
    {&NoiseConfig::drift_yaw_deg, {0.05, 0.1, 0.1}},
    {&NoiseConfig::forward_sigma, {0.03, 0.05, 0.08}},
    {&NoiseConfig::turn_sigma_deg, {1, 2, 2}},
    {&NoiseConfig::slip, {0.005, 0.01, 0.01}},
    {&NoiseConfig::drop, {0.01, 0.01, 0.02}},
    {&NoiseConfig::exposure_stops, {0.2, 0.3, 0.3}},
    {&NoiseConfig::blur_px, {4, 6, 10}},
    {&NoiseConfig::depth_step_per_m2, {0, 0.00287, 0}},
    {&NoiseConfig::depth_angle_sigma_m, {0.0001, 0.0001, 0.0001}},
    {&NoiseConfig::depth_flying, {0.15, 0.2, 0.15}},
    {&NoiseConfig::depth_grazing_hole, {0.8, 0.9, 0.9}},
    {&NoiseConfig::depth_dark_hole, {0.2, 0.5, 0.2}},
    {&NoiseConfig::depth_glass_hole, {0.7, 0.9, 0.8}},
    {&NoiseConfig::rolling_px, {2, 4, 6}},
};
constexpr std::array<int, 3> kLoopClosure_steps = {150, 150, 100};

}  // namespace

NoiseConfig NoiseOfProfile(const std::string& profile) {
  NoiseConfig noise;
  for (std::size_t k = 0; k < kProfiles.size(); ++k) {
    if (profile != kProfiles[k]) continue;
    for (const Row& row : kRows) noise.*row.setting = row.values[k];
    noise.loop_closure_steps = kLoopClosure_steps[k];
  }
  noise.profile = profile;
  return noise;
}

}  // namespace crossnav::sim
