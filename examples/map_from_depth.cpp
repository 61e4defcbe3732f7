// SPDX-License-Identifier: MIT
// A map from depth images and camera poses: free space, surfaces, lines of sight. Writes the
// surfaces as a point cloud.
//   map_from_depth [OUT.ply]
#include <cstdio>

#include "box_room.h"
#include "crossnav/core/version.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/store/export_ply.h"

int main(int argc, char** argv) {
  const BoxRoom room;
  crossnav::SensorConfig sensor;
  sensor.width_px = sensor.height_px = 160;
  crossnav::AgentPose robot;

  crossnav::geometry::VoxelMap map;  // 0.10 m voxels, see geometry::MapConfig
  for (int i = 0; i < 12; ++i) {
    const crossnav::Observation seen = Look(room, robot, sensor);  // your camera and its pose
    map.Integrate(seen.depth_m, seen.camera, seen.T_world_camera);
    map.ObserveBody(robot.p_world, sensor.camera_height_m);
    map.UpdateStates();
    Move(room, robot, crossnav::Action::kTurnLeft);
  }

  const crossnav::geometry::MapStats stats = map.Stats();
  std::printf("crossnav %s: %lld surface voxels, %lld to walk through, %lld bytes\n",
              CROSSNAV_VERSION, static_cast<long long>(stats.occupied),
              static_cast<long long>(stats.traversable), static_cast<long long>(stats.bytes));
  std::printf("behind the box: %s\n",
              map.HasLineOfSight({0, 0, 0.5}, {2.5, 0, 0.5}) ? "in sight" : "out of sight");
  if (argc > 1) {
    const auto points = crossnav::store::StatePoints(map, true);
    if (auto ok = crossnav::store::WritePly(argv[1], points); !ok) {
      std::fprintf(stderr, "%s\n", ok.error().Message().c_str());
      return 1;
    }
  }
  return 0;
}
