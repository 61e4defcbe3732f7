// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

SensorConfig SmallSensor() {
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = 64;
  return sensor;
}

struct SimulatorWorld {
  Scene scene;
  RayCaster caster{scene};
  NavMesh navmesh;
  Simulator simulator;

  explicit SimulatorWorld(Scene s)
      : scene(std::move(s)),
        navmesh(std::move(*NavMesh::Build(scene, {}))),
        simulator(scene, navmesh, caster, SmallSensor(), {}) {}
};

TEST(Simulator, ForwardMovesAQuarterMetreWhereItLooks) {
  SimulatorWorld w(TwoFloors());
  ASSERT_TRUE(w.simulator.Reset({{3, 3, 0}, 0, 0}).has_value());
  EXPECT_NEAR(w.simulator.Step(Action::kMoveForward), 0.25, 1e-4);
  EXPECT_NEAR(w.simulator.agent().p_world.x(), 3.25, 1e-4);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(w.simulator.Step(Action::kTurnLeft), 0);
  EXPECT_NEAR(w.simulator.Step(Action::kMoveForward), 0.25, 1e-4);
  EXPECT_NEAR(w.simulator.agent().p_world.y(), 3.25, 1e-4);
  for (int i = 0; i < 12; ++i) w.simulator.Step(Action::kTurnRight);
  EXPECT_NEAR(w.simulator.agent().yaw_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_EQ(w.simulator.Step(Action::kStop), 0);
}

TEST(Simulator, PitchIsClamped) {
  SimulatorWorld w(TwoFloors());
  ASSERT_TRUE(w.simulator.Reset({{3, 3, 0}, 0, 3.0}).has_value());
  EXPECT_NEAR(w.simulator.agent().pitch_rad, DegToRad(60), 1e-9);
  for (int i = 0; i < 10; ++i) w.simulator.Step(Action::kLookDown);
  EXPECT_NEAR(w.simulator.agent().pitch_rad, DegToRad(-60), 1e-9);
  w.simulator.Step(Action::kLookUp);
  EXPECT_NEAR(w.simulator.agent().pitch_rad, DegToRad(-30), 1e-9);
}

TEST(Simulator, ABadStartIsAnErrorAndKeepsTheOldPose) {
  SimulatorWorld w(TwoFloors());
  ASSERT_TRUE(w.simulator.Reset({{3, 3, 0}, 0.5, 0}).has_value());
  for (const AgentPose& bad : {AgentPose{{NAN, 3, 0}, 0, 0}, AgentPose{{3, 3, 0}, INFINITY, 0},
                               AgentPose{{3, 3, 0}, 0, NAN}, AgentPose{{-9, 3, 0}, 0, 0}}) {
    const auto result = w.simulator.Reset(bad);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::kInvalid);
  }
  EXPECT_NEAR(w.simulator.agent().yaw_rad, 0.5, 1e-9);
}

TEST(Simulator, AWallStopsItWithoutSliding) {
  SimulatorWorld w(TwoFloors());
  ASSERT_TRUE(w.simulator.Reset({{9.0, 3, 0}, DegToRad(30), 0}).has_value());
  double moved = 0;
  for (int i = 0; i < 20; ++i) moved += w.simulator.Step(Action::kMoveForward);
  const Vector3d p = w.simulator.agent().p_world;
  EXPECT_NEAR(p.x(), 9.88, 0.06);
  EXPECT_NEAR((p.y() - 3) / (p.x() - 9), std::tan(DegToRad(30)), 0.02);
  EXPECT_NEAR(moved, 0.88 / std::cos(DegToRad(30)), 0.08);
  EXPECT_LT(w.simulator.Step(Action::kMoveForward), 0.02);
  for (int i = 0; i < 6; ++i) w.simulator.Step(Action::kTurnLeft);
  EXPECT_NEAR(w.simulator.Step(Action::kMoveForward), 0.25, 1e-3);
}

/// Height of the ground truth's flight of stairs at x.
double StairHeight(double x) {
  if (x < kFlight_x) return 0;
  return std::min(3.0, (std::floor((x - kFlight_x) / kGoing_m) + 1) * kRise_m);
}

TEST(Simulator, ClimbsSeventeenStairsWithTheCameraOverTheTreads) {
  SimulatorWorld w(TwoFloors());
  ASSERT_TRUE(w.simulator.Reset({{0.5, 0.5, 0}, 0, 0}).has_value());
  for (int i = 0; i < 40 && w.simulator.agent().p_world.z() < 2.99; ++i) {
    const double before_x = w.simulator.agent().p_world.x();
    w.simulator.Step(Action::kMoveForward);
    const Vector3d p = w.simulator.agent().p_world;
    ASSERT_NEAR(p.x() - before_x, 0.25, 1e-3) << "blocked at x " << p.x();
    EXPECT_NEAR(p.z(), StairHeight(p.x()), 0.05) << "x " << p.x();
    const Observation obs = w.simulator.Observe();
    EXPECT_NEAR(obs.T_world_camera.translation().z() - StairHeight(p.x()), 0.88, 0.05);
  }
  EXPECT_NEAR(w.simulator.agent().p_world.z(), 3, 0.05);
  EXPECT_EQ(w.navmesh.FloorOf(w.simulator.agent().p_world), 1);
  // And down again.
  for (int i = 0; i < 6; ++i) w.simulator.Step(Action::kTurnLeft);
  for (int i = 0; i < 30; ++i) w.simulator.Step(Action::kMoveForward);
  EXPECT_NEAR(w.simulator.agent().p_world.z(), 0, 0.05);
}

TEST(Simulator, ObservationsMatchThePoseAndRepeat) {
  SimulatorWorld a(TwoFloors()), b(TwoFloors());
  for (SimulatorWorld* w : {&a, &b}) {
    ASSERT_TRUE(w->simulator.Reset({{3, 3, 0}, 0.7, 0}).has_value());
    for (const Action action :
         {Action::kMoveForward, Action::kTurnLeft, Action::kLookDown, Action::kMoveForward}) {
      w->simulator.Step(action);
    }
  }
  const Observation x = a.simulator.Observe(), y = b.simulator.Observe();
  EXPECT_EQ(x.rgb.data, y.rgb.data);
  EXPECT_EQ(x.depth_m.data, y.depth_m.data);
  EXPECT_TRUE(x.T_world_camera.isApprox(CameraPose(a.simulator.agent(), 0.88), 1e-12));
  // The centre ray's depth ends on a surface.
  const Vector3d p = x.T_world_camera * BackProjectPixel(x.camera, 32, 60, x.depth_m.At(32, 60));
  EXPECT_NEAR(p.z(), 0, 0.02);
}

}  // namespace
}  // namespace crossnav::sim::test
