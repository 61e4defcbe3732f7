// SPDX-License-Identifier: MIT
// A robot that wakes up in a house of boxes, with a map of that house or of another.
#pragma once

#include <cmath>
#include <utility>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/localization/awakening.h"
#include "support/box_walker.h"

namespace crossnav::test {

inline SensorConfig SmallSensor() {
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = 96;
  return sensor;
}

/// Views of a camera at the walkers' height from places `apart_m` apart on each storey.
inline geometry::VoxelMap MapOf(const crossnav::testing::BoxRooms& rooms, int storeys = 1,
                                double apart_m = 1.3) {
  constexpr double kStorey_m = 2.8;  // as MakeBoxHouse
  geometry::VoxelMap map;
  BoxWalker walker{rooms, {}, SmallSensor(), {}};
  const Box3& shell = rooms.shell;
  for (int storey = 0; storey < storeys; ++storey)
    for (double x = shell.min.x() + 0.4; x < shell.max.x(); x += apart_m)
      for (double y = shell.min.y() + 0.4; y < shell.max.y(); y += apart_m) {
        walker.pose.p_world = {x, y, storey * kStorey_m};
        if (!walker.IsFree(walker.pose.p_world)) continue;
        for (int view = 0; view < 8; ++view) {
          walker.pose.yaw_rad = DegToRad(90 * (view / 2));
          walker.pose.pitch_rad = DegToRad(view % 2 == 0 ? 0 : -30);
          const Observation obs = walker.Look();
          map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
        }
        map.ObserveBody(walker.pose.p_world, walker.sensor.camera_height_m);
      }
  map.UpdateStates();
  return map;
}

struct Waking {
  localization::LocalizeStep answer;
  int actions = 0;
  double off_m = 0, off_deg = 0;
  bool IsRight() const {
    return answer.status == localization::Status::kKnown && off_m < 0.25 && off_deg < 5;
  }
};

/// Lets the walker find itself in `map`; its odometry starts where it stands.
inline Waking WakeUp(BoxWalker walker, const geometry::VoxelMap& map,
                     const localization::LocalizeConfig& config = {}) {
  localization::Body body;
  body.camera_height_m = walker.sensor.camera_height_m;
  body.action = walker.action;
  auto awakening = localization::Awakening::In(map, body, config).value();
  const Pose T_odom_world = localization::FootFrameOf(walker.pose).inverse();
  for (;;) {
    Observation obs = walker.Look();
    obs.T_world_camera = T_odom_world * obs.T_world_camera;
    const auto step = awakening.Step(obs);
    if (awakening.IsOver()) {
      const Pose T_map_world = step.T_map_odom * T_odom_world;
      Waking waking{step, awakening.actions(), 0, 0};
      waking.off_m = (T_map_world * walker.pose.p_world - walker.pose.p_world).norm();
      waking.off_deg = std::abs(RadToDeg(localization::YawOf(T_map_world)));
      return waking;
    }
    walker.Do(step.action);
  }
}

}  // namespace crossnav::test
