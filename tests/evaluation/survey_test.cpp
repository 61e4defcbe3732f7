// SPDX-License-Identifier: MIT
// Initial knowledge of the variants known-map and known-objects.
#include "crossnav/evaluation/running/survey.h"

#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "evaluation/embedded_house_fixture.h"
#include "sim/micro_scene.h"

namespace crossnav::evaluation {
namespace {

using geometry::KeyOf;

RunConfig Config() {
  RunConfig config = test::SmallConfig();
  EXPECT_TRUE(ApplyVariant("known-objects", config));
  return config;
}

class Survey : public testing::Test {
 protected:
  void SetUp() override {
    auto context = SceneContext::Of(sim::test::TwoFloors(), config_);
    ASSERT_TRUE(context) << context.error().Message();
    context_ = std::move(*context);
  }
  RunConfig config_ = Config();
  std::unique_ptr<SceneContext> context_;
};

TEST_F(Survey, TheMapHoldsTheGroundOfBothFloorsAndNoNames) {
  const auto survey = SurveyScene(*context_, config_, Known::kMap);
  ASSERT_TRUE(survey) << survey.error().Message();
  int seen = 0, all = 0;
  for (const Vector3d& p : context_->WalkablePoints()) {
    ++all;
    bool is_known = false;
    for (const double below_m : {0.05, 0.15, -0.05}) {
      const auto key = KeyOf(p - Vector3d(0, 0, below_m), config_.agent.map.voxel_m);
      is_known = is_known || geometry::IsSurface(survey->map.StateAt(key));
    }
    seen += is_known ? 1 : 0;
  }
  EXPECT_GT(seen, 0.95 * all);
  EXPECT_EQ(survey->memory.Size(), 0);
  EXPECT_FALSE(survey->seen_stairs.empty());
}

TEST_F(Survey, ObjectsAreNamedWhereTheyStand) {
  const auto survey = SurveyScene(*context_, config_, Known::kObjects);
  ASSERT_TRUE(survey) << survey.error().Message();
  sim::Simulator simulator(context_->scene(), context_->navmesh(), context_->caster(),
                           config_.agent.sensor, config_.agent.action);
  auto suite = sim::GroundTruthPerception(simulator, config_.ground_truth);
  ASSERT_TRUE(suite);
  const auto text = suite->encoder->EncodeText("bed");
  ASSERT_TRUE(text);
  const auto places = memory::Query(survey->memory, *text, config_.agent.query);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT((places[0].p_center_world - Vector3d(8, 4.7, 3.4)).norm(), 0.5);
}

TEST_F(Survey, TwoSurveysAreTheSame) {
  const auto a = SurveyScene(*context_, config_, Known::kObjects);
  const auto b = SurveyScene(*context_, config_, Known::kObjects);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->map.Stats().occupied, b->map.Stats().occupied);
  ASSERT_EQ(a->memory.Size(), b->memory.Size());
  for (std::int64_t row = 0; row < a->memory.Size(); ++row)
    ASSERT_EQ(a->memory.RowAt(row), b->memory.RowAt(row));
}

TEST_F(Survey, FeaturesOfNetworksAreNotMadeUp) {
  config_.eval.perception = "networks";
  const auto survey = SurveyScene(*context_, config_, Known::kObjects);
  ASSERT_FALSE(survey);
  EXPECT_NE(survey.error().Message().find("known-objects"), std::string::npos);
  EXPECT_EQ(KnownOf("full"), Known::kNothing);
}

/// Gives the agent a survey before its first goal.
class Teller : public RunObserver {
 public:
  explicit Teller(SceneSurvey survey) : survey_(std::move(survey)) {}
  Result<void> OnStart(agent::Agent& state) override {
    return state.Restore(std::move(survey_.map), std::move(survey_.memory),
                         std::move(survey_.flights), survey_.seen_stairs);
  }

 private:
  SceneSurvey survey_;
};

TEST_F(Survey, AnInformedAgentWalksLessAndItsRecordHasTheParts) {
  Episode episode;
  episode.scene_id = "micro";
  episode.start.p_world = Vector3d(1, 0.5, 0);
  episode.goals = {"bed"};
  auto survey = SurveyScene(*context_, config_, Known::kObjects);
  ASSERT_TRUE(survey) << survey.error().Message();
  Teller teller(std::move(*survey));
  RunObserver* const observers[] = {&teller};
  const auto told = RunEpisode(*context_, episode, config_, observers);
  ASSERT_TRUE(told) << told.error().Message();
  ASSERT_TRUE(told->IsComplete());
  const StageRecord& stage = told->stages[0];
  EXPECT_LT(stage.length_m, 1.5 * stage.shortest_m);
  ASSERT_TRUE(stage.extra.walk && stage.extra.walk->reach);
  const StageWalk& walk = *stage.extra.walk;
  EXPECT_EQ(walk.forward + walk.turn + walk.look + 1, stage.actions);  // and STOP
  EXPECT_LE(walk.reach->walked_m, stage.length_m);
  EXPECT_GT(walk.reach->walked_m, walk.reach->reach_shortest_m - 0.3);
}

}  // namespace
}  // namespace crossnav::evaluation
