// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/simulator.h"

#include <algorithm>
#include <cmath>

namespace crossnav::sim {
namespace {

// chosen: the navmesh follows the surface to a few centimetres, and to half a riser on stairs.
constexpr double kGroundSearch_m = 0.30;

/// The surface under a navmesh point: of the surfaces within reach, the nearest in height.
Vector3d OnGround(const RayCaster& caster, const Vector3d& p_navmesh) {
  Vector3d from = p_navmesh + Vector3d(0, 0, kGroundSearch_m);
  double range_m = 2 * kGroundSearch_m;
  double best_z = p_navmesh.z(), best_m = kGroundSearch_m;
  bool found = false;
  for (int surface = 0; surface < 8 && range_m > 0; ++surface) {
    const auto hit = caster.Cast(from, -Vector3d::UnitZ(), range_m);
    if (!hit) break;
    const double off_m = std::abs(hit->p_world.z() - p_navmesh.z());
    if (!found || off_m < best_m) {
      best_z = hit->p_world.z();
      best_m = off_m;
      found = true;
    }
    from.z() = hit->p_world.z() - 1e-3;
    range_m -= hit->distance_m + 1e-3;
  }
  return {p_navmesh.x(), p_navmesh.y(), best_z};
}

}  // namespace

Simulator::Simulator(const Scene& scene, const NavMesh& navmesh, const RayCaster& caster,
                     const SensorConfig& sensor, const ActionConfig& action)
    : scene_(scene), navmesh_(navmesh), caster_(caster), sensor_(sensor), action_(action) {}

Result<void> Simulator::Reset(const AgentPose& start) {
  if (!start.p_world.allFinite() || !std::isfinite(start.yaw_rad) ||
      !std::isfinite(start.pitch_rad)) {
    return Fail(ErrorCode::kInvalid, "the start pose is not finite", scene_.id);
  }
  const auto p = navmesh_.Snap(start.p_world);
  if (!p) {
    return Fail(ErrorCode::kInvalid, "no walkable ground within 0.5 m of the start position",
                scene_.id);
  }
  const double max_pitch = DegToRad(action_.max_pitch_deg);
  agent_.p_world = OnGround(caster_, *p);
  agent_.yaw_rad = WrapAngle(start.yaw_rad);
  agent_.pitch_rad = std::clamp(start.pitch_rad, -max_pitch, max_pitch);
  if (noise_) noise_->Start(agent_);
  return {};
}

void Simulator::UseNoise(const NoiseConfig& noise, std::uint64_t episode_seed) {
  noise_.emplace(noise, episode_seed);
  if (!noise_->IsOn()) noise_.reset();
  glass_.clear();
  if (!noise_ || noise.depth_glass_hole <= 0) return;
  for (const SceneInstance& instance : scene_.instances)
    if (IsGlass(instance.name)) glass_.insert(instance.id);
}

double Simulator::Step(Action action) {
  const double moved_m = Execute(action);
  if (noise_) noise_->Moved(action, agent_);
  return moved_m;
}

double Simulator::Execute(Action action) {
  const double max_pitch = DegToRad(action_.max_pitch_deg);
  const auto tilt = [&](double by) {
    agent_.pitch_rad = std::clamp(agent_.pitch_rad + by, -max_pitch, max_pitch);
  };
  const auto turn = [&](double by) {
    if (noise_) by += noise_->TurnError_rad();
    agent_.yaw_rad = WrapAngle(agent_.yaw_rad + by);
  };
  switch (action) {
    case Action::kTurnLeft:
      turn(DegToRad(action_.turn_deg));
      return 0;
    case Action::kTurnRight:
      turn(-DegToRad(action_.turn_deg));
      return 0;
    case Action::kLookUp:
      tilt(DegToRad(action_.pitch_deg));
      return 0;
    case Action::kLookDown:
      tilt(-DegToRad(action_.pitch_deg));
      return 0;
    case Action::kStop:
      return 0;
    case Action::kMoveForward:
      break;
  }
  const Vector3d ahead(std::cos(agent_.yaw_rad), std::sin(agent_.yaw_rad), 0);
  const Vector3d before = agent_.p_world;
  const double length_m = action_.forward_m * (noise_ ? noise_->MoveFactor() : 1);
  if (length_m == 0) return 0;
  const Vector3d reached = navmesh_.WalkStraight(before, before + length_m * ahead);
  agent_.p_world = OnGround(caster_, reached);
  return (agent_.p_world - before).norm();
}

Observation Simulator::Observe() {
  Observation observation;
  observation.camera = sensor_.Intrinsics();
  observation.T_world_camera = CameraPose(agent_, sensor_.camera_height_m);
  frame_ = caster_.Render(observation.camera, observation.T_world_camera, channels_);
  ++frames_;
  if (noise_) {
    observation.T_world_camera = CameraPose(noise_->believed(), sensor_.camera_height_m);
    noise_->Disturb(frame_, observation.camera, glass_);
  }
  observation.rgb = frame_.rgb;
  observation.depth_m = frame_.depth_m;
  return observation;
}

}  // namespace crossnav::sim
