// SPDX-License-Identifier: MIT
// Stand-in for your robot and its camera: an empty room with a red box in it, as depth and colour.
// World frame, metres.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/core/action.h"
#include "crossnav/core/observation.h"

struct BoxRoom {
  crossnav::Vector3d lo{-3, -2, 0}, hi{3, 2, 2.5};
  crossnav::Vector3d box_lo{1.5, -0.3, 0}, box_hi{2.0, 0.4, 0.9};
};

/// Intersection of the ray from `p` inside the room with the box, in lengths of `d`; infinity =
/// none.
inline double HitOfBox(const BoxRoom& room, const crossnav::Vector3d& p,
                       const crossnav::Vector3d& d) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (room.box_lo[axis] - p[axis]) / d[axis];
    const double b = (room.box_hi[axis] - p[axis]) / d[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// Intersection with a wall, the floor or the ceiling.
inline double HitOfWall(const BoxRoom& room, const crossnav::Vector3d& p,
                        const crossnav::Vector3d& d) {
  double hit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double limit = d[axis] > 0 ? room.hi[axis] : room.lo[axis];
    if (d[axis] != 0) hit = std::min(hit, (limit - p[axis]) / d[axis]);
  }
  return hit;
}

/// Camera image from `robot`. A ray of length 1 along z has planar depth as its parameter.
inline crossnav::Observation Look(const BoxRoom& room, const crossnav::AgentPose& robot,
                                  const crossnav::SensorConfig& sensor) {
  crossnav::Observation seen;
  seen.camera = sensor.Intrinsics();
  seen.T_world_camera = crossnav::CameraPose(robot, sensor.camera_height_m);
  seen.depth_m = crossnav::DepthImage(sensor.width_px, sensor.height_px);
  seen.rgb = crossnav::RgbImage(sensor.width_px, sensor.height_px);
  for (int v = 0; v < sensor.height_px; ++v) {
    for (int u = 0; u < sensor.width_px; ++u) {
      const crossnav::Vector3d ray =
          seen.T_world_camera.linear() * crossnav::BackProjectPixel(seen.camera, u, v, 1.0);
      const double wall = HitOfWall(room, seen.T_world_camera.translation(), ray);
      const double box = HitOfBox(room, seen.T_world_camera.translation(), ray);
      seen.depth_m.At(u, v) = static_cast<float>(std::min(wall, box));
      seen.rgb.At(u, v) = box < wall ? crossnav::Rgb8{200, 20, 20} : crossnav::Rgb8{180, 180, 180};
    }
  }
  return seen;
}

/// Carries out an action; a step into an obstacle does not move the robot.
inline void Move(const BoxRoom& room, crossnav::AgentPose& robot, crossnav::Action action) {
  const crossnav::ActionConfig size;
  switch (action) {
    case crossnav::Action::kMoveForward: {
      const crossnav::Vector3d p =
          robot.p_world +
          size.forward_m * crossnav::Vector3d(std::cos(robot.yaw_rad), std::sin(robot.yaw_rad), 0);
      const auto within = [&](const crossnav::Vector3d& lo, const crossnav::Vector3d& hi,
                              double m) {
        return p.x() > lo.x() - m && p.x() < hi.x() + m && p.y() > lo.y() - m && p.y() < hi.y() + m;
      };
      if (within(room.lo, room.hi, -0.15) && !within(room.box_lo, room.box_hi, 0.15)) {
        robot.p_world = p;
      }
      break;
    }
    case crossnav::Action::kTurnLeft:
      robot.yaw_rad += crossnav::DegToRad(size.turn_deg);
      break;
    case crossnav::Action::kTurnRight:
      robot.yaw_rad -= crossnav::DegToRad(size.turn_deg);
      break;
    case crossnav::Action::kLookUp:
      robot.pitch_rad += crossnav::DegToRad(size.pitch_deg);
      break;
    case crossnav::Action::kLookDown:
      robot.pitch_rad -= crossnav::DegToRad(size.pitch_deg);
      break;
    case crossnav::Action::kStop:
      break;
  }
}
