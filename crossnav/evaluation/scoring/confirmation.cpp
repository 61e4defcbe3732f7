// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/confirmation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "crossnav/policy/approach.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::evaluation {
namespace {

constexpr double kSamePlace_m = 0.2;  // chosen: less than a forward action

/// Middle of the part of the box at which the agent's approach would point the camera
/// (policy::AimPoint: up to 1 m beyond the nearest point).
Vector3d AimAt(const Box3& box, const Vector3d& p_foot) {
  constexpr double kDepth_m = 1.0;
  const double reach_m = box.HorizontalDistance(p_foot) + kDepth_m;
  Vector3d aim = box.Center();
  for (int axis = 0; axis < 2; ++axis) {
    const double low = std::max(box.min[axis], p_foot[axis] - reach_m);
    const double high = std::min(box.max[axis], p_foot[axis] + reach_m);
    aim[axis] = (low + high) / 2;
  }
  return aim;
}

sim::SeenInstance SeenIn(const sim::Frame& frame, int id, MaskImage& mask) {
  sim::SeenInstance seen;
  mask = MaskImage(frame.instance.width, frame.instance.height);
  for (int v = 0; v < frame.instance.height; ++v) {
    for (int u = 0; u < frame.instance.width; ++u) {
      if (frame.instance.At(u, v) != id) continue;
      seen.Add(u, v, frame.depth_m.At(u, v));
      mask.At(u, v) = 1;
    }
  }
  return seen;
}

/// Possible pitches of the camera with `elevation_rad` in the picture, nearest first.
std::vector<double> PitchesTowards(double elevation_rad, const RunConfig& config) {
  const ActionConfig& action = config.agent.action;
  const double half_view_rad = DegToRad(config.agent.sensor.hfov_deg) / 2;
  const int most = static_cast<int>(std::floor(action.max_pitch_deg / action.pitch_deg + 1e-9));
  std::vector<double> pitches;
  for (int i = -most; i <= most; ++i) {
    const double pitch_rad = DegToRad(i * action.pitch_deg);
    if (std::abs(pitch_rad - elevation_rad) < half_view_rad) pitches.push_back(pitch_rad);
  }
  std::sort(pitches.begin(), pitches.end(), [&](double a, double b) {
    return std::abs(a - elevation_rad) < std::abs(b - elevation_rad);
  });
  return pitches;
}

}  // namespace

bool ConfirmationRule::IsConfirmedAt(const AgentPose& pose) const {
  const SensorConfig& sensor = config_.agent.sensor;
  const policy::PolicyConfig& policy = config_.agent.policy;
  const double voxel_m = config_.agent.map.voxel_m;
  Observation obs;
  obs.camera = sensor.Intrinsics();
  obs.T_world_camera = CameraPose(pose, sensor.camera_height_m);
  sim::Frame frame = caster_.Render(obs.camera, obs.T_world_camera, sim::Channels::kWithoutColour);
  MaskImage mask;
  auto detection =
      sim::DetectionOf(SeenIn(frame, instance_.id, mask), sensor, config_.ground_truth);
  if (!detection) return false;
  detection->mask = std::move(mask);
  detection->mask_quality = 1;
  obs.depth_m = std::move(frame.depth_m);
  const auto sightings = policy::LiftDetections({*detection}, obs, config_.agent.map, policy.object,
                                                policy.object.detector_confidence);
  policy::LivePois pois;  // state after the pictures that a stable POI requires
  for (int step = 0; step < policy.object.stable_frames; ++step)
    pois.Update(sightings, policy.object, voxel_m, step);
  const auto stable = pois.Stable(policy.object);
  return !stable.empty() && policy::Verify(*stable.front(), sightings,
                                           {obs, pose, sensor.camera_height_m}, policy, voxel_m)
                                .passed;
}

bool ConfirmationRule::IsConfirmedFrom(const Vector3d& p_foot) const {
  const Vector3d p_eye = p_foot + Vector3d(0, 0, config_.agent.sensor.camera_height_m);
  const Vector3d d = AimAt(instance_.box, p_foot) - p_eye;
  const double yaw_rad = std::atan2(d.y(), d.x());
  const double half_turn_rad = DegToRad(config_.agent.action.turn_deg) / 2;
  const auto pitches = PitchesTowards(std::atan2(d.z(), std::hypot(d.x(), d.y())), config_);
  for (const double off_rad : {-half_turn_rad, half_turn_rad}) {
    const bool is_confirmed = std::any_of(pitches.begin(), pitches.end(), [&](double pitch_rad) {
      return IsConfirmedAt({p_foot, WrapAngle(yaw_rad + off_rad), pitch_rad});
    });
    if (!is_confirmed) return false;
  }
  return true;
}

std::optional<Vector3d> ConfirmationRule::FirstOf(std::vector<Vector3d> points) const {
  const auto key = [&](const Vector3d& p) {
    return std::tuple(instance_.box.HorizontalDistance(p), p.x(), p.y(), p.z());
  };
  std::sort(points.begin(), points.end(),
            [&](const Vector3d& a, const Vector3d& b) { return key(a) < key(b); });
  std::vector<Vector3d> tried;
  for (const Vector3d& p : points) {
    const bool is_known = std::any_of(tried.begin(), tried.end(), [&](const Vector3d& other) {
      return (p - other).norm() < kSamePlace_m - 1e-6;
    });
    if (is_known) continue;
    if (IsConfirmedFrom(p)) return p;
    tried.push_back(p);
  }
  return std::nullopt;
}

}  // namespace crossnav::evaluation
