// SPDX-License-Identifier: MIT
// Each row of the paper's frozen configuration (tab:supp_configuration) by the effect of the
// defaults: the simulator's actions, the navmesh, the encoder's output, the evaluator and the
// dataset.
#include <gtest/gtest.h>

#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/sensing/simulator.h"
#include "evaluation/embedded_house_fixture.h"
#include "sim/micro_scene.h"

namespace crossnav::evaluation {
namespace {

using sim::test::MicroScene;

const RunConfig kWorldConfig;

sim::NavMesh MeshOf(const sim::Scene& scene) {
  auto mesh = sim::NavMesh::Build(scene, kWorldConfig.navmesh);
  EXPECT_TRUE(mesh.has_value());
  return std::move(*mesh);
}

/// Whether a path leads along a corridor of 6 x 4 m past the additions of `block`.
template <class F>
bool IsPassable(const F& block) {
  MicroScene m;
  m.Room(0, 0, 6, 4);
  m.Begin("block");
  block(m);
  const sim::Scene scene = m.Finish();
  return MeshOf(scene).Geodesic({1, 2, 0}, {5, 2, 0}).has_value();
}

TEST(ConfigPaperWorld, NavMeshHeightClimbAndRadius) {
  const auto sill = [](double m_high) {
    return IsPassable([&](MicroScene& m) { m.Box({2.9, 0, 0}, {3.1, 4, m_high}); });
  };
  EXPECT_TRUE(sill(0.30));
  EXPECT_FALSE(sill(0.36));  // a cell of 0.05 m more
  const auto beam = [](double m_high) {
    return IsPassable([&](MicroScene& m) { m.Box({2.5, 0, m_high}, {3.5, 4, 2.6}); });
  };
  EXPECT_TRUE(beam(1.60));  // two cells of 0.05 m more
  EXPECT_FALSE(beam(1.45));
  const auto gap = [](double width_m) {
    return IsPassable([&](MicroScene& m) {
      m.Box({2.9, 0, 0}, {3.1, 2 - width_m / 2, 2.6});
      m.Box({2.9, 2 + width_m / 2, 0}, {3.1, 4, 2.6});
    });
  };
  EXPECT_TRUE(gap(0.36));  // 2 x 0.10 m in whole cells of 0.03 m, and a cell more
  EXPECT_FALSE(gap(0.18));
}

TEST(ConfigPaperWorld, NavMeshSlope) {
  for (const double slope_deg : {50.0, 63.0}) {
    MicroScene m;
    m.Room(0, 0, 6, 4);
    m.Begin("ramp");
    const double run = 1.2, rise = run * std::tan(DegToRad(slope_deg));
    m.Quad({2, 1, 0}, {2, 3, 0}, {2 + run, 3, rise}, {2 + run, 1, rise});
    const sim::Scene scene = m.Finish();
    const auto heights = MeshOf(scene).HeightsAt(2 + run / 2, 2, 0.4, 2.4);
    EXPECT_EQ(heights.empty(), slope_deg > 60) << slope_deg;
  }
}

TEST(ConfigPaperWorld, ForwardStepAndIncrements) {
  MicroScene m;
  m.Room(0, 0, 6, 4);
  const sim::Scene scene = m.Finish();
  const sim::NavMesh mesh = MeshOf(scene);
  const sim::RayCaster caster(scene);
  sim::Simulator simulator(scene, mesh, caster, kWorldConfig.agent.sensor,
                           kWorldConfig.agent.action);
  ASSERT_TRUE(simulator.Reset({{2, 2, 0}, 0, 0}).has_value());
  EXPECT_NEAR(simulator.Step(Action::kMoveForward), 0.25, 1e-4);
  simulator.Step(Action::kTurnLeft);
  simulator.Step(Action::kLookDown);
  EXPECT_NEAR(RadToDeg(simulator.agent().yaw_rad), 30, 1e-9);
  EXPECT_NEAR(RadToDeg(simulator.agent().pitch_rad), -30, 1e-9);
}

TEST(ConfigPaperWorld, SuccessRadius) {
  Target target;
  target.box = {Vector3d(0, 0, 0), Vector3d(1, 1, 1)};
  target.floors = {0};
  EXPECT_TRUE(IsWithinBoxRadius(target, {2.49, 0.5, 0}, 0, kWorldConfig.eval));
  EXPECT_FALSE(IsWithinBoxRadius(target, {2.51, 0.5, 0}, 0, kWorldConfig.eval));
}

class ConfigPaperHouse : public test::EmbeddedHouseTest {};

TEST_F(ConfigPaperHouse, EpisodesHaveThreeGoalsOfSixCategories) {
  const GeneratorScene scene{scene_id_, context_.get()};
  GeneratorOptions options;
  options.count = 12;
  const auto file = GenerateEpisodes({&scene, 1}, kWorldConfig, options);
  ASSERT_TRUE(file) << file.error().Message();
  for (const Episode& episode : file->episodes) EXPECT_EQ(episode.goals.size(), 3u);
  EXPECT_EQ((std::set<std::string_view>(kCategories.begin(), kCategories.end())),
            (std::set<std::string_view>{"chair", "bed", "toilet", "plant", "sofa", "tv_monitor"}));
}

}  // namespace
}  // namespace crossnav::evaluation
