// SPDX-License-Identifier: MIT
// Which instances the agent's detection rule can confirm, in a room of boxes.
#include "crossnav/evaluation/scoring/confirmation.h"

#include "crossnav/evaluation/generation/episode_generator.h"
#include "evaluation/embedded_house_fixture.h"
#include "sim/micro_scene.h"
#include "support/temp_folder.h"

namespace crossnav::evaluation {
namespace {

using sim::test::MicroScene;

constexpr int kSofa = 5, kPlant = 6, kCactus = 7;  // ids: floor, ceiling, wall and shelf are first

/// A sofa, a plant on the floor, and a cactus of 5 cm on a shelf .5 m high.
sim::Scene Room() {
  MicroScene m;
  m.Room(0, 0, 6, 5);
  m.Begin("shelf");
  m.Box({2.5, 0, 0}, {3.5, 0.4, 0.5});
  m.Begin("couch", "sofa");
  m.Box({0.2, 4, 0}, {2.2, 4.8, 0.8});
  m.Begin("plant", "plant");
  m.Box({5.2, 4.2, 0}, {5.6, 4.6, 0.9});
  m.Begin("cactus", "plant");
  m.Box({2.95, 0.15, 0.5}, {3.0, 0.2, 0.55});
  return m.Finish();
}

RunConfig ByDetection() {
  RunConfig config = test::SmallConfig();
  config.dataset.certificate = "detection";
  return config;
}

std::unique_ptr<SceneContext> Context(const RunConfig& config) {
  auto context = SceneContext::Of(Room(), config);
  EXPECT_TRUE(context) << context.error().Message();
  return std::move(*context);
}

const Target& TargetOf(const SceneContext& context, const std::string& goal, int instance) {
  const auto& targets = context.TargetsOf(goal);
  return *std::find_if(targets.begin(), targets.end(),
                       [&](const Target& t) { return t.instance == instance; });
}

TEST(Confirmation, ASmallThingOnAShelfHasViewpointsAndIsConfirmedFromNone) {
  const RunConfig config = ByDetection();
  const auto context = Context(config);
  const Target& cactus = TargetOf(*context, "plant", kCactus);
  ASSERT_FALSE(cactus.viewpoints_world.empty());
  EXPECT_TRUE(cactus.confirmed_world.empty());
  EXPECT_FALSE(cactus.is_confirmable);
  for (const auto& [goal, id] : {std::pair("sofa", kSofa), std::pair("plant", kPlant)}) {
    const Target& target = TargetOf(*context, goal, id);
    ASSERT_EQ(target.confirmed_world.size(), 1U) << goal;  // one floor, one part
    EXPECT_TRUE(target.is_confirmable);
  }
}

TEST(Confirmation, APlaceConfirmsAsTheAgentsThresholdsSay) {
  RunConfig config = ByDetection();
  const sim::Scene scene = Room();
  const sim::RayCaster caster(scene);
  const sim::SceneInstance& plant = *scene.FindInstance(kPlant);
  const Vector3d p_near(4.6, 4.2, 0), p_far(2.5, 3.0, 0);
  EXPECT_TRUE(ConfirmationRule(caster, plant, config).IsConfirmedFrom(p_near));
  EXPECT_FALSE(ConfirmationRule(caster, plant, config).IsConfirmedFrom(p_far));
  const auto refuses = [&](auto&& change) {
    RunConfig strict = config;
    change(strict);
    return !ConfirmationRule(caster, plant, strict).IsConfirmedFrom(p_near);
  };
  EXPECT_TRUE(refuses([](RunConfig& c) { c.agent.policy.object.min_box_area_fraction = 0.9; }));
  EXPECT_TRUE(refuses([](RunConfig& c) { c.agent.policy.object.min_projected_voxels = 5000; }));
  EXPECT_TRUE(refuses([](RunConfig& c) { c.agent.policy.object.found_confidence = 0.99; }));
  EXPECT_TRUE(refuses([](RunConfig& c) { c.agent.policy.approach.range_m = 0.3; }));
}

TEST(Confirmation, AnUnconfirmableInstanceCertifiesNothing) {
  const auto plain = Context(test::SmallConfig());
  EXPECT_TRUE(TargetOf(*plain, "plant", kCactus).is_confirmable);  // edition 1 does not ask
  const auto context = Context(ByDetection());
  const Vector3d p_below(2.9, 0.6, 0);  // at the shelf
  EXPECT_LT(*plain->DistanceToGoal(p_below, "plant"), 0.5);
  EXPECT_GT(*context->DistanceToGoal(p_below, "plant"), 3);
}

TEST(Confirmation, MarksOfAFileAreUsedWithoutLookingAgain) {
  const auto judged = Context(ByDetection());
  EpisodeFile file;
  AddGoalObjects({"micro/micro.glb", judged.get()}, file);
  file.certificate_edition = 2;
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "e.json";
  ASSERT_TRUE(WriteEpisodes(path, file));
  const auto read = ReadEpisodes(path);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->certificate_edition, 2);
  const auto context = Context(test::SmallConfig());
  context->UseMarks(read->goals_by_category, "micro/micro.glb");
  EXPECT_FALSE(TargetOf(*context, "plant", kCactus).is_confirmable);
  EXPECT_TRUE(TargetOf(*context, "plant", kPlant).is_confirmable);
  EXPECT_TRUE(CheckMarks(*judged, "micro/micro.glb", read->goals_by_category).empty());
  auto wrong = read->goals_by_category;
  for (GoalObject& goal : wrong.at("micro.glb_plant")) goal.is_confirmable = true;
  const auto problems = CheckMarks(*judged, "micro/micro.glb", wrong);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].find("not confirmed"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::evaluation
