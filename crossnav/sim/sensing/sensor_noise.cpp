// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/sensor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::sim {
namespace {

enum Stream : std::uint64_t { kActions = 1, kDrift, kDrops, kDepth, kColour };
bool HasDepthNoise(const NoiseConfig& n) {
  return n.depth_sigma_m > 0 || n.depth_sigma_per_m2 > 0 || n.depth_step_per_m2 > 0 ||
         n.depth_shift_px > 0 || n.depth_edge_hole > 0 || n.depth_hole_share > 0 ||
         n.depth_max_m > 0 || n.depth_angle_sigma_m > 0 || n.depth_flying > 0 ||
         n.depth_grazing_hole > 0 || n.depth_dark_hole > 0 || n.depth_glass_hole > 0;
}

bool HasDrift(const NoiseConfig& n) {
  return n.drift_xy_m > 0 || n.drift_z_m > 0 || n.drift_yaw_deg > 0;
}

bool HasColourNoise(const NoiseConfig& n) {
  return n.exposure_stops > 0 || n.blur_px > 0 || n.rolling_px > 0;
}

bool HasActionNoise(const NoiseConfig& n) {
  return n.forward_sigma > 0 || n.turn_sigma_deg > 0 || n.slip > 0;
}

void Expose(double gain, RgbImage& rgb) {
  std::array<std::uint8_t, 256> exposed{};
  for (std::size_t c = 0; c < exposed.size(); ++c)
    exposed[c] =
        static_cast<std::uint8_t>(std::clamp(std::lround(static_cast<double>(c) * gain), 0L, 255L));
  for (Rgb8& colour : rgb.data) colour = {exposed[colour.r], exposed[colour.g], exposed[colour.b]};
}

/// Rolling exposure while the camera turns: each row is shifted sideways by its share of `last_px`.
/// Pixels from outside the picture repeat its border.
void Roll(double last_px, RgbImage& rgb) {
  std::vector<Rgb8> row(static_cast<std::size_t>(rgb.width));
  for (int v = 0; v < rgb.height; ++v) {
    const int by = static_cast<int>(std::lround(last_px * v / std::max(1, rgb.height - 1)));
    if (by == 0) continue;
    for (int u = 0; u < rgb.width; ++u)
      row[static_cast<std::size_t>(u)] = rgb.At(std::clamp(u - by, 0, rgb.width - 1), v);
    std::copy(row.begin(), row.end(),
              rgb.data.begin() + static_cast<std::ptrdiff_t>(v) * rgb.width);
  }
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

RgbImage NoisyColour(const NoiseConfig& noise, const RgbImage& rgb, std::uint64_t seed) {
  Rng rng(seed);
  const double stops = noise.exposure_stops * rng.Normal();
  const int length_px = 1 + static_cast<int>(std::floor(rng.Uniform() * noise.blur_px));
  RgbImage noisy = rgb;
  if (noise.exposure_stops > 0) Expose(std::exp2(stops), noisy);
  if (noise.rolling_px > 0) Roll(noise.rolling_px * (2 * rng.Uniform() - 1), noisy);
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
  believed_.pitch_rad = true_pose.pitch_rad;  // gravity is measured
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

void SensorNoise::Disturb(Frame& frame, const CameraIntrinsics& camera,
                          const std::set<std::int32_t>& glass) {
  const std::uint64_t frame_seed = MixSeed(seed_, frames_++);
  if (noise_.drop > 0 && drop_rng_.Chance(noise_.drop)) {
    frame.instance = InstanceImage(frame.instance.width, frame.instance.height);
    frame.depth_m = DepthImage(frame.depth_m.width, frame.depth_m.height);
    frame.rgb = RgbImage(frame.rgb.width, frame.rgb.height);
  } else {
    if (HasDepthNoise(noise_)) {
      frame.depth_m =
          NoisyDepth(noise_, frame.depth_m, MixSeed(frame_seed, kDepth),
                     {camera, frame.rgb.empty() ? nullptr : &frame.rgb, &frame.instance, &glass});
    }
    if (HasColourNoise(noise_) && !frame.rgb.empty()) {
      frame.rgb = NoisyColour(noise_, frame.rgb, MixSeed(frame_seed, kColour));
    }
  }
}

}  // namespace crossnav::sim
