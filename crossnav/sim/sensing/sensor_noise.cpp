// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/sensor_noise.h"

#include <algorithm>
#include <cmath>

namespace crossnav::sim {
namespace {

// chosen: side of a patch without depth; shiny and dark things are about so large [px of 640]
constexpr int kPatch_px = 16;
// chosen: neighbours whose depths differ by this share are on both sides of an edge
constexpr double kEdgeShare = 0.05;

enum Stream : std::uint64_t { kActions = 1, kDrift, kDrops, kDepth, kColour };
enum DepthStream : std::uint64_t { kShifts = 1, kEdges, kPatches, kReadings };

DepthImage Shifted(const DepthImage& depth_m, double sigma_px, Rng rng) {
  DepthImage shifted = depth_m;
  for (int v = 0; v < depth_m.height; ++v) {
    for (int u = 0; u < depth_m.width; ++u) {
      const int from_u = u + static_cast<int>(std::lround(sigma_px * rng.Normal()));
      const int from_v = v + static_cast<int>(std::lround(sigma_px * rng.Normal()));
      shifted.At(u, v) = depth_m.At(std::clamp(from_u, 0, depth_m.width - 1),
                                    std::clamp(from_v, 0, depth_m.height - 1));
    }
  }
  return shifted;
}

/// Whether the perfect picture jumps between this pixel and one of its four neighbours.
bool IsEdge(const DepthImage& depth_m, int u, int v) {
  const float here = depth_m.At(u, v);
  const auto jumps = [&](int nu, int nv) {
    if (!depth_m.Contains(nu, nv)) return false;
    const float there = depth_m.At(nu, nv);
    return std::abs(there - here) > kEdgeShare * std::min(there, here);
  };
  return jumps(u - 1, v) || jumps(u + 1, v) || jumps(u, v - 1) || jumps(u, v + 1);
}

void LoseEdges(const DepthImage& perfect_m, double probability, Rng rng, DepthImage& depth_m) {
  for (int v = 0; v < depth_m.height; ++v) {
    for (int u = 0; u < depth_m.width; ++u) {
      if (IsEdge(perfect_m, u, v) && rng.Chance(probability)) depth_m.At(u, v) = 0;
    }
  }
}

void LosePatches(double share, Rng rng, DepthImage& depth_m) {
  for (int v0 = 0; v0 < depth_m.height; v0 += kPatch_px) {
    for (int u0 = 0; u0 < depth_m.width; u0 += kPatch_px) {
      if (!rng.Chance(share)) continue;
      for (int v = v0; v < std::min(v0 + kPatch_px, depth_m.height); ++v) {
        const auto row = depth_m.data.begin() + static_cast<std::ptrdiff_t>(v) * depth_m.width;
        std::fill(row + u0, row + std::min(u0 + kPatch_px, depth_m.width), 0.0F);
      }
    }
  }
}

float Reading(const NoiseConfig& noise, double z_m, Rng& rng) {
  const double sigma_m = DepthSigma(noise, z_m);
  double read_m = sigma_m > 0 ? z_m + sigma_m * rng.Normal() : z_m;
  if (read_m <= 0) return 0;
  const double step_m = noise.depth_step_per_m2 * z_m * z_m;
  if (step_m > 0) read_m = std::round(read_m / step_m) * step_m;
  if (noise.depth_max_m > 0 && read_m > noise.depth_max_m) return 0;
  return static_cast<float>(read_m);
}

bool HasDepthNoise(const NoiseConfig& n) {
  return n.depth_sigma_m > 0 || n.depth_sigma_per_m2 > 0 || n.depth_step_per_m2 > 0 ||
         n.depth_shift_px > 0 || n.depth_edge_hole > 0 || n.depth_hole_share > 0 ||
         n.depth_max_m > 0;
}

bool HasDrift(const NoiseConfig& n) {
  return n.drift_xy_m > 0 || n.drift_z_m > 0 || n.drift_yaw_deg > 0;
}

bool HasColourNoise(const NoiseConfig& n) {
  return n.exposure_stops > 0 || n.blur_px > 0;
}

bool HasActionNoise(const NoiseConfig& n) {
  return n.forward_sigma > 0 || n.turn_sigma_deg > 0 || n.slip > 0;
}

Rgb8 Exposed(Rgb8 colour, double gain) {
  const auto channel = [&](std::uint8_t c) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(c * gain), 0L, 255L));
  };
  return {channel(colour.r), channel(colour.g), channel(colour.b)};
}

/// Mean over `length_px` neighbours in the row, the pixel in their middle.
void BlurRows(int length_px, RgbImage& rgb) {
  const int before = length_px / 2, after = length_px - 1 - before;
  std::vector<Rgb8> row(static_cast<std::size_t>(rgb.width));
  for (int v = 0; v < rgb.height; ++v) {
    for (int u = 0; u < rgb.width; ++u) {
      const int lo = std::max(0, u - before), hi = std::min(rgb.width - 1, u + after);
      int r = 0, g = 0, b = 0;
      for (int i = lo; i <= hi; ++i) {
        const Rgb8& c = rgb.At(i, v);
        r += c.r, g += c.g, b += c.b;
      }
      const int n = hi - lo + 1;
      row[static_cast<std::size_t>(u)] = {static_cast<std::uint8_t>(r / n),
                                          static_cast<std::uint8_t>(g / n),
                                          static_cast<std::uint8_t>(b / n)};
    }
    std::copy(row.begin(), row.end(),
              rgb.data.begin() + static_cast<std::ptrdiff_t>(v) * rgb.width);
  }
}

}  // namespace

DepthImage NoisyDepth(const NoiseConfig& noise, const DepthImage& depth_m, std::uint64_t seed) {
  DepthImage noisy = noise.depth_shift_px > 0
                         ? Shifted(depth_m, noise.depth_shift_px, Rng(seed, kShifts))
                         : depth_m;
  if (noise.depth_edge_hole > 0) {
    LoseEdges(depth_m, noise.depth_edge_hole, Rng(seed, kEdges), noisy);
  }
  if (noise.depth_hole_share > 0) LosePatches(noise.depth_hole_share, Rng(seed, kPatches), noisy);
  Rng rng(seed, kReadings);
  for (float& z_m : noisy.data) {
    if (z_m > 0) z_m = Reading(noise, z_m, rng);
  }
  return noisy;
}

RgbImage NoisyColour(const NoiseConfig& noise, const RgbImage& rgb, std::uint64_t seed) {
  Rng rng(seed);
  const double stops = noise.exposure_stops * rng.Normal();
  const int length_px = 1 + static_cast<int>(std::floor(rng.Uniform() * noise.blur_px));
  RgbImage noisy = rgb;
  if (noise.exposure_stops > 0) {
    for (Rgb8& colour : noisy.data) colour = Exposed(colour, std::exp2(stops));
  }
  if (length_px > 1) BlurRows(length_px, noisy);
  return noisy;
}

SensorNoise::SensorNoise(const NoiseConfig& noise, std::uint64_t episode_seed)
    : noise_(noise),
      is_on_(HasDepthNoise(noise) || HasDrift(noise) || HasColourNoise(noise) ||
             HasActionNoise(noise) || noise.drop > 0),
      seed_(MixSeed(noise.seed, episode_seed)),
      action_rng_(seed_, kActions),
      drift_rng_(seed_, kDrift),
      drop_rng_(seed_, kDrops) {}

double SensorNoise::MoveFactor() {
  const bool has_slipped = action_rng_.Chance(noise_.slip);
  const double factor = 1 + noise_.forward_sigma * action_rng_.Normal();
  return has_slipped ? 0 : std::max(0.0, factor);
}

double SensorNoise::TurnError_rad() {
  return DegToRad(noise_.turn_sigma_deg) * action_rng_.Normal();
}

void SensorNoise::Start(const AgentPose& true_pose) {
  frames_ = 0;
  action_rng_ = Rng(seed_, kActions);
  drift_rng_ = Rng(seed_, kDrift);
  drop_rng_ = Rng(seed_, kDrops);
  true_pose_ = believed_ = true_pose;
}

void SensorNoise::Moved(Action action, const AgentPose& true_pose) {
  if (!HasDrift(noise_)) {
    believed_ = true_pose_ = true_pose;
    return;
  }
  const double off_rad = WrapAngle(believed_.yaw_rad - true_pose_.yaw_rad);
  const Eigen::AngleAxisd turned(off_rad, Vector3d::UnitZ());
  believed_.p_world += turned * (true_pose.p_world - true_pose_.p_world);
  believed_.yaw_rad = true_pose.yaw_rad + off_rad;
  believed_.pitch_rad = true_pose.pitch_rad;  // gravity is felt
  if (action == Action::kMoveForward) {
    believed_.p_world.x() += noise_.drift_xy_m * drift_rng_.Normal();
    believed_.p_world.y() += noise_.drift_xy_m * drift_rng_.Normal();
    believed_.p_world.z() += noise_.drift_z_m * drift_rng_.Normal();
  }
  if (action == Action::kMoveForward || action == Action::kTurnLeft ||
      action == Action::kTurnRight) {
    believed_.yaw_rad += DegToRad(noise_.drift_yaw_deg) * drift_rng_.Normal();
  }
  believed_.yaw_rad = WrapAngle(believed_.yaw_rad);
  CloseLoop(true_pose);
  true_pose_ = true_pose;
}

void SensorNoise::CloseLoop(const AgentPose& true_pose) {
  if (noise_.loop_closure_steps == 0) return;
  if (!drift_rng_.Chance(1.0 / noise_.loop_closure_steps)) return;
  const double gain = noise_.loop_closure_gain;
  const double off_rad = WrapAngle(believed_.yaw_rad - true_pose.yaw_rad);
  believed_.p_world += gain * (true_pose.p_world - believed_.p_world);
  believed_.yaw_rad = WrapAngle(believed_.yaw_rad - gain * off_rad);
}

void SensorNoise::Disturb(Frame& frame) {
  const std::uint64_t frame_seed = MixSeed(seed_, frames_++);
  if (noise_.drop > 0 && drop_rng_.Chance(noise_.drop)) {
    frame.instance = InstanceImage(frame.instance.width, frame.instance.height);
    frame.depth_m = DepthImage(frame.depth_m.width, frame.depth_m.height);
    frame.rgb = RgbImage(frame.rgb.width, frame.rgb.height);
  } else {
    if (HasDepthNoise(noise_)) {
      frame.depth_m = NoisyDepth(noise_, frame.depth_m, MixSeed(frame_seed, kDepth));
    }
    if (HasColourNoise(noise_) && !frame.rgb.empty()) {
      frame.rgb = NoisyColour(noise_, frame.rgb, MixSeed(frame_seed, kColour));
    }
  }
}

NoiseConfig NoiseOfProfile(const std::string& profile) {
  NoiseConfig noise;
  if (profile == "realsense") {
    // chosen: sub-pixel stereo, 1.5 % at 2 m; visual-inertial odometry of about 1 % of the path
    noise.depth_sigma_m = 0.001;
    noise.depth_sigma_per_m2 = 0.0037;
    noise.depth_shift_px = 0.5;
    noise.depth_edge_hole = 0.3;
    noise.depth_hole_share = 0.02;
    noise.depth_max_m = 8;
    noise.drift_xy_m = 0.003;
    noise.drift_z_m = 0.001;
    noise.drift_yaw_deg = 0.05;
    noise.loop_closure_steps = 150;
    noise.forward_sigma = 0.03;
    noise.turn_sigma_deg = 1;
    noise.slip = 0.005;
    noise.drop = 0.01;
    noise.exposure_stops = 0.2;
    noise.blur_px = 4;
  } else if (profile == "kinect") {
    // chosen: structured light, 14 mm at 3 m (Nguyen et al. 2012), steps of 1/8 px of disparity
    noise.depth_sigma_m = 0.0012;
    noise.depth_sigma_per_m2 = 0.00142;
    noise.depth_step_per_m2 = 0.00287;
    noise.depth_shift_px = 0.5;
    noise.depth_edge_hole = 0.5;
    noise.depth_hole_share = 0.03;
    noise.depth_max_m = 5;
    noise.drift_xy_m = 0.005;
    noise.drift_z_m = 0.001;
    noise.drift_yaw_deg = 0.1;
    noise.loop_closure_steps = 150;
    noise.forward_sigma = 0.05;
    noise.turn_sigma_deg = 2;
    noise.slip = 0.01;
    noise.drop = 0.01;
    noise.exposure_stops = 0.3;
    noise.blur_px = 6;
  } else if (profile == "spot") {
    // chosen: stereo of a walking robot, short range and shaken; legs drift more than wheels
    noise.depth_sigma_m = 0.002;
    noise.depth_sigma_per_m2 = 0.005;
    noise.depth_shift_px = 0.7;
    noise.depth_edge_hole = 0.5;
    noise.depth_hole_share = 0.05;
    noise.depth_max_m = 4;
    noise.drift_xy_m = 0.006;
    noise.drift_z_m = 0.003;
    noise.drift_yaw_deg = 0.1;
    noise.loop_closure_steps = 100;
    noise.forward_sigma = 0.08;
    noise.turn_sigma_deg = 2;
    noise.slip = 0.01;
    noise.drop = 0.02;
    noise.exposure_stops = 0.3;
    noise.blur_px = 10;
  }
  noise.profile = profile;
  return noise;
}

}  // namespace crossnav::sim
