// SPDX-License-Identifier: MIT
// Imperfect sensors: noise on perfect frames, poses and steps. The same settings, seed and calls
// give the same bytes. Every kind of noise draws from its own stream, so that its settings do not
// change another kind's draws.
#pragma once

#include <cstdint>
#include <set>
#include <string_view>

#include "crossnav/core/action.h"
#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/sensing/noise_config.h"

namespace crossnav::sim {

/// Standard deviation of a depth reading at planar depth `z_m` [m].
inline double DepthSigma(const NoiseConfig& noise, double z_m) {
  return noise.depth_sigma_m + noise.depth_sigma_per_m2 * z_m * z_m;
}

/// Whether objects of this name are glass or mirrors for a depth camera.
bool IsGlass(std::string_view name);

/// Inputs of depth noise besides depth. Missing inputs have no effect.
struct Scenery {
  CameraIntrinsics camera;        ///< width 0 = missing
  const RgbImage* rgb = nullptr;  ///< as large as depth
  const InstanceImage* instance = nullptr;
  const std::set<std::int32_t>* glass = nullptr;  ///< instances of glass, and mirrors
};

/// Applies, in this order: shifted pixels, flying pixels, lost edges, patches without depth, loss
/// at dark, grazing and glass surfaces, noise, steps, range. Invalid pixels (0) stay invalid;
/// depths of 0 or below become invalid.
DepthImage NoisyDepth(const NoiseConfig& noise, const DepthImage& depth_m, std::uint64_t seed,
                      const Scenery& scenery = {});

/// Exposure, rolling exposure, then motion blur.
RgbImage NoisyColour(const NoiseConfig& noise, const RgbImage& rgb, std::uint64_t seed);

/// Noise of one episode.
class SensorNoise {
 public:
  /// `episode_seed` makes episodes differ; noise.seed is mixed with it.
  SensorNoise(const NoiseConfig& noise, std::uint64_t episode_seed);

  /// With all noise off, draws no numbers and copies no images.
  bool IsOn() const { return is_on_; }

  /// Executed share of a move's length: 0 = slipped, 1 = perfect.
  double MoveFactor();
  /// Error of a turn [rad].
  double TurnError_rad();

  /// Begins the episode anew: the same numbers are drawn again. The agent believes the truth.
  void Start(const AgentPose& true_pose);
  /// Updates the odometry by the true motion of `action`.
  void Moved(Action action, const AgentPose& true_pose);
  /// Reported pose, with drift, in the world frame of the start.
  const AgentPose& believed() const { return believed_; }

  /// Makes a frame imperfect. A lost frame has no depth and no instances and is black. `glass`:
  /// instances of glass, and mirrors.
  void Disturb(Frame& frame, const CameraIntrinsics& camera, const std::set<std::int32_t>& glass);

 private:
  void CloseLoop(const AgentPose& true_pose);

  NoiseConfig noise_;
  bool is_on_;
  std::uint64_t seed_;
  std::uint64_t frames_ = 0;
  Rng action_rng_, drift_rng_, drop_rng_;
  AgentPose true_pose_, believed_;
};

}  // namespace crossnav::sim
