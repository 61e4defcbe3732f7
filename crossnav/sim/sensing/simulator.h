// SPDX-License-Identifier: MIT
// The robot in the scene: six discrete actions on the navmesh, and the camera. Deterministic.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "crossnav/core/action.h"
#include "crossnav/core/camera.h"
#include "crossnav/core/observation.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/sensor_noise.h"

namespace crossnav::sim {

class Simulator {
 public:
  /// All three must outlive the simulator.
  Simulator(const Scene& scene, const NavMesh& navmesh, const RayCaster& caster,
            const SensorConfig& sensor, const ActionConfig& action);

  /// Places the agent; the point is snapped to the navmesh. Error if none is near or it is not
  /// finite.
  Result<void> Reset(const AgentPose& start);

  /// Executes one action (kStop does nothing). A blocked forward stops at the obstacle: no sliding.
  /// Returns the distance really moved [m].
  double Step(Action action);

  /// Renders the current view. Also keeps the frame for ground-truth perception. Under noise the
  /// pose is the believed one.
  Observation Observe();

  /// Whether observations carry colour; without it their pictures are black and come sooner.
  void ShowColour(bool is_wanted) {
    channels_ = is_wanted ? Channels::kAll : Channels::kWithoutColour;
  }

  /// Applies `noise` to steps, poses and frames from the next Reset on; the same seed gives the
  /// same noise. With all settings off nothing changes.
  void UseNoise(const NoiseConfig& noise, std::uint64_t episode_seed);

  const AgentPose& agent() const { return agent_; }  ///< the true one
  const Frame& last_frame() const { return frame_; }
  std::int64_t frames() const { return frames_; }  ///< rendered so far, the last one included
  const Scene& scene() const { return scene_; }
  const NavMesh& navmesh() const { return navmesh_; }
  const RayCaster& caster() const { return caster_; }
  const SensorConfig& sensor() const { return sensor_; }

 private:
  const Scene& scene_;
  const NavMesh& navmesh_;
  const RayCaster& caster_;
  SensorConfig sensor_;
  ActionConfig action_;
  double Execute(Action action);

  AgentPose agent_;
  std::optional<SensorNoise> noise_;  // nothing = perfect
  std::set<std::int32_t> glass_;      // instances of glass, and mirrors; empty while perfect
  Frame frame_;
  std::int64_t frames_ = 0;
  Channels channels_ = Channels::kAll;
};

}  // namespace crossnav::sim
