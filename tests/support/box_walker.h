// SPDX-License-Identifier: MIT
// A walker in a house of boxes: the effect of the agent's actions and the resulting sensor data,
// without the simulator. A forward step ends at a box, climbs up to 0.3 m, and never descends more
// than that. World frame, metres.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"
#include "support/box_rooms.h"
#include "support/fake_perception.h"

namespace crossnav::test {

struct BoxWalker {
  crossnav::testing::BoxRooms rooms;
  AgentPose pose;
  SensorConfig sensor;
  ActionConfig action;
  double radius_m = 0.1;
  double drift_z_m = 0;          ///< that a forward step adds to the believed height
  double most_drift_z_m = 0.05;  ///< where it turns round
  double believed_above_m = 0;   ///< by how much it is wrong by now

  Observation Look() const {
    Observation obs;
    obs.camera = sensor.Intrinsics();
    obs.T_world_camera = CameraPose(pose, sensor.camera_height_m);
    obs.depth_m = crossnav::testing::RenderDepth(rooms, obs.camera, obs.T_world_camera);
    obs.T_world_camera.translation().z() += believed_above_m;
    obs.rgb = RgbImage(sensor.width_px, sensor.height_px);
    return obs;
  }

  /// Height of the ground at (x, y) for a foot at height `from_m`: the highest top of a box within
  /// a step, or the floor.
  double GroundAt(const Vector3d& p, double from_m) const {
    constexpr double kClimb_m = 0.3;
    double ground_m = rooms.shell.min.z();
    for (const Box3& solid : rooms.solids)
      if (solid.HorizontalDistance(p) <= 0 && solid.max.z() <= from_m + kClimb_m + 1e-9)
        ground_m = std::max(ground_m, solid.max.z());
    return ground_m;
  }

  /// Standing at `p` (its z is the ground's) the body touches nothing that it cannot step onto.
  bool IsFree(const Vector3d& p) const {
    const Box3& shell = rooms.shell;
    if (p.x() < shell.min.x() + radius_m || p.x() > shell.max.x() - radius_m ||
        p.y() < shell.min.y() + radius_m || p.y() > shell.max.y() - radius_m)
      return false;
    for (const Box3& solid : rooms.solids)
      if (solid.min.z() < p.z() + 1.5 && solid.max.z() > p.z() + 0.3 + 1e-9 &&
          solid.HorizontalDistance(p) < radius_m)
        return false;
    return true;
  }

  void Do(Action what) {
    const double turn = DegToRad(action.turn_deg), pitch = DegToRad(action.pitch_deg),
                 limit = DegToRad(action.max_pitch_deg);
    if (what == Action::kTurnLeft) pose.yaw_rad = WrapAngle(pose.yaw_rad + turn);
    if (what == Action::kTurnRight) pose.yaw_rad = WrapAngle(pose.yaw_rad - turn);
    if (what == Action::kLookUp) pose.pitch_rad = std::min(limit, pose.pitch_rad + pitch);
    if (what == Action::kLookDown) pose.pitch_rad = std::max(-limit, pose.pitch_rad - pitch);
    if (what != Action::kMoveForward) return;
    believed_above_m += drift_z_m;
    if (std::abs(believed_above_m) >= most_drift_z_m) drift_z_m = -drift_z_m;
    // In five parts, until it is blocked: steps may be climbed, drops are not taken.
    for (int part = 0; part < 5; ++part) {
      Vector3d next =
          pose.p_world +
          action.forward_m / 5 * Vector3d(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad), 0);
      next.z() = GroundAt(next, pose.p_world.z());
      if (next.z() < pose.p_world.z() - 0.3 - 1e-9 || !IsFree(next)) return;
      pose.p_world = next;
    }
  }
};

/// A detector and segmenter that know the pixels of `object`: pixels with their end point on it.
inline void SeeBox(const Box3& object, std::string_view name, FakeSight* sight) {
  const auto mask_of = [object](const Observation& obs) {
    MaskImage mask(obs.rgb.width, obs.rgb.height, 0);
    for (int v = 0; v < mask.height; ++v)
      for (int u = 0; u < mask.width; ++u) {
        const Vector3d p =
            obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
        mask.At(u, v) = (p.array() > object.min.array() - 0.01).all() &&
                        (p.array() < object.max.array() + 0.01).all() &&
                        p.z() > object.min.z() + 0.02;
      }
    return mask;
  };
  sight->detect = [mask_of, goal_name = std::string(name)](const Observation& obs,
                                                           std::string_view goal) {
    std::vector<perception::Detection> found;
    if (goal != goal_name) return found;
    const MaskImage mask = mask_of(obs);
    perception::Detection detection;
    detection.box = {mask.width, mask.height, 0, 0};
    for (int v = 0; v < mask.height; ++v)
      for (int u = 0; u < mask.width; ++u) {
        if (!mask.At(u, v)) continue;
        auto& box = detection.box;
        box = {std::min(box.u0, u), std::min(box.v0, v), std::max(box.u1, u + 1),
               std::max(box.v1, v + 1)};
      }
    detection.confidence = 0.9F;
    if (detection.box.u1 > 0) found.push_back(detection);
    return found;
  };
  sight->segment = [mask_of](const Observation& obs, perception::Detection& detection) {
    detection.mask = mask_of(obs);
    detection.mask_quality = 0.9F;
  };
}

}  // namespace crossnav::test
