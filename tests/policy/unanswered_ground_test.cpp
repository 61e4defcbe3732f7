// SPDX-License-Identifier: MIT
// A camera over a platform that ends in nothing, as the worlds of scans and drawn homes do.
#include "crossnav/policy/unanswered_ground.h"

#include <gtest/gtest.h>

#include "crossnav/core/camera.h"
#include "crossnav/core/rng.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::policy {
namespace {

constexpr double kEdge_m = 2.0;  // the platform is x in [-2, 2], z = 0

struct Platform {
  SensorConfig sensor;
  geometry::VoxelMap map;
  planner::GroundMap ground{map.config()};
  UnansweredGround unanswered;
  std::vector<geometry::VoxelKey> settled;

  Platform() { sensor.width_px = sensor.height_px = 160; }

  /// Camera view of the platform; `wall_m` < 0: none, else an upright plane at that x.
  Observation Look(const AgentPose& agent, double wall_m = -1) const {
    Observation obs;
    obs.camera = sensor.Intrinsics();
    obs.T_world_camera = CameraPose(agent, sensor.camera_height_m);
    obs.depth_m = DepthImage(sensor.width_px, sensor.height_px);
    const Vector3d o = obs.T_world_camera.translation();
    for (int v = 0; v < sensor.height_px; ++v)
      for (int u = 0; u < sensor.width_px; ++u) {
        const Vector3d ray = obs.T_world_camera.linear() * BackProjectPixel(obs.camera, u, v, 1);
        const double t = ray.z() < 0 ? -o.z() / ray.z() : 0;
        if (t > 0 && std::abs((o + t * ray).x()) <= kEdge_m) obs.depth_m.At(u, v) = float(t);
        const double to_wall = wall_m > 0 && ray.x() > 0 ? (wall_m - o.x()) / ray.x() : 1e9;
        // As a sensor that answers nothing nearer than half a metre.
        if (wall_m > 0 && to_wall < 1e8 && (t == 0 || to_wall < t))
          obs.depth_m.At(u, v) = to_wall < 0.5 ? 0.0F : float(to_wall);
      }
    return obs;
  }
  void Add(const AgentPose& agent, const Observation& obs) {
    map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    map.ObserveBody(agent.p_world, sensor.camera_height_m);
    ground.Update(map.UpdateStates());
    for (const auto& key : unanswered.Look(obs, agent.p_world, map)) {
      settled.push_back(key);
      ground.NoteUnanswered(key);
    }
  }
};

AgentPose At(double x_m, double pitch_deg = -30) {
  return {Vector3d(x_m, 0.05, 0), 0, DegToRad(pitch_deg)};
}

TEST(UnansweredGround, BeyondTheEdgeOfAWorldIsNothingToBeSeen) {
  Platform given;
  for (const double x_m : {-1.0, -0.5, 0.0, 0.5, 1.0, 1.4, 1.7})
    for (int i = 0; i < 4; ++i) given.Add(At(x_m), given.Look(At(x_m)));
  ASSERT_FALSE(given.settled.empty());
  for (const auto& key : given.settled)
    EXPECT_GE(geometry::CenterOf(key, 0.1).x(), kEdge_m - 0.05) << "on the platform";
  const auto edge = given.ground.StandingAt(Vector3d(kEdge_m - 0.05, 0.05, 0));
  ASSERT_TRUE(edge);
  int z = 0;
  EXPECT_EQ(given.ground.OutcomeOf(*edge, 1, 0, &z), planner::StepOutcome::kDrop);
}

TEST(UnansweredGround, AFrameOrTwoSettleNothing) {
  Platform given;
  for (int i = 0; i < 2; ++i) given.Add(At(0.5), given.Look(At(0.5)));
  EXPECT_TRUE(given.settled.empty());
}

TEST(UnansweredGround, HolesOfNoiseAreNoEdge) {
  Platform given;
  Rng rng(3);
  for (int i = 0; i < 12; ++i) {
    Observation obs = given.Look(At(-1.5));
    for (float& depth_m : obs.depth_m.data)
      if (rng.Chance(0.05)) depth_m = 0;
    given.Add(At(-1.5), obs);
  }
  for (const auto& key : given.settled)
    EXPECT_GE(geometry::CenterOf(key, 0.1).x(), kEdge_m - 0.05) << "on the platform";
}

TEST(UnansweredGround, BehindANearWallNothingIsSettled) {
  Platform given;
  const double wall_m = 0.4;
  for (int i = 0; i < 5; ++i) given.Add(At(0, 0), given.Look(At(0, 0), wall_m));
  for (const auto& key : given.settled)
    EXPECT_LT(geometry::CenterOf(key, 0.1).x(), wall_m + 0.6) << "rooms behind it stay unseen";
}

}  // namespace
}  // namespace crossnav::policy
