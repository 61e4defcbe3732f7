// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/runner.h"

#include <cmath>

#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/trace/trace_json.h"
#include "evaluation/embedded_house_fixture.h"

namespace crossnav::evaluation {
namespace {

/// All events as text, and the agent's path.
class Recorder : public RunObserver {
 public:
  Result<void> OnStep(const StepView& step) override {
    text_ += trace::ToJson(step.trace) + "\n";
    if (!path_.empty()) length_m_ += (step.agent.p_world - path_.back()).norm();
    path_.push_back(step.agent.p_world);
    goals_.push_back(step.trace.goal);
    return {};
  }
  std::string text_;
  std::vector<Vector3d> path_;
  std::vector<std::string> goals_;
  double length_m_ = 0;
};

class Runner : public test::EmbeddedHouseTest {
 protected:
  static Episode ClimbingEpisode() {
    const GeneratorScene scene{scene_id_, context_.get()};
    auto episode = MakeEpisode(scene, test::SmallConfig(), {"sofa", "toilet", "bed"}, 0, 1);
    EXPECT_TRUE(episode) << episode.error().Message();
    return episode ? *episode : Episode{};
  }
  static bool IsGoalReachedAt(const Vector3d& p_world) {
    return IsGoalReached(*context_, context_->TargetsOf("bed"), p_world, EvalConfig{});
  }
  static RunConfig ShortConfig(int budget) {
    RunConfig config = test::SmallConfig();
    config.eval.action_budget = budget;
    return config;
  }
};

TEST_F(Runner, SameSeedGivesTheSameRecordsAndTraces) {
  const Episode episode = ClimbingEpisode();
  const RunConfig config = ShortConfig(60);
  std::string records[2], traces[2];
  for (int i = 0; i < 2; ++i) {
    Recorder recorder;
    RunObserver* observers[] = {&recorder};
    const auto record = RunEpisode(*context_, episode, config, observers);
    ASSERT_TRUE(record) << record.error().Message();
    records[i] = ToJsonLine(*record, /*with_timings=*/false);
    traces[i] = recorder.text_;
  }
  EXPECT_EQ(records[0], records[1]);
  EXPECT_EQ(traces[0], traces[1]);
  EXPECT_FALSE(traces[0].empty());
}

// Viewpoints of an ObjectNav file are X(g): shortest path and success follow from them.
TEST_F(Runner, ViewpointsOfAnEpisodeFileReplaceOurs) {
  RunConfig config = test::SmallConfig();
  config.eval.success = "viewpoint";
  auto context = SceneContext::Load(folder_->path(), scene_id_, config);
  ASSERT_TRUE(context) << context.error().Message();
  const Target ours = (*context)->TargetsOf("toilet").front();
  const Vector3d p_far = (*context)->TargetsOf("sofa").front().viewpoints_world.front();
  EXPECT_GT(*(*context)->DistanceToGoal(p_far, "toilet"),
            1);  // earlier results are discarded
  GoalObject goal;
  goal.object_id = ours.instance;
  goal.category = "toilet";
  goal.p_world = ours.box.Center();
  goal.viewpoints_world = {p_far};
  const std::string file = std::filesystem::path(scene_id_).filename().string();
  (*context)->UseGoals({{file + "_toilet", {goal}}, {"Other.glb_bed", {goal}}}, scene_id_);
  const auto& targets = (*context)->TargetsOf("toilet");
  ASSERT_EQ(targets.size(), 1u);
  EXPECT_EQ(targets[0].instance, ours.instance);
  EXPECT_TRUE(targets[0].box.min.isApprox(ours.box.min));
  EXPECT_NEAR(*(*context)->DistanceToGoal(p_far, "toilet"), 0, 0.1);
  EXPECT_TRUE(IsGoalReached(**context, targets, p_far, config.eval));
  EXPECT_FALSE(IsGoalReached(**context, targets, ours.viewpoints_world.front(), config.eval));
  EXPECT_GT((*context)->TargetsOf("bed").front().viewpoints_world.size(), 1u);  // of another scene
}

// A stage that began where the agent had walked onto a sliver of the mesh ended the whole episode
// as failed: "cannot be reached from where its stage starts".
TEST_F(Runner, AStageOffTheMeshStartsFromTheNearestConnectedPlace) {
  const Vector3d p_floor = context_->TargetsOf("sofa").front().viewpoints_world.front();
  const auto from_floor_m = context_->DistanceToGoal(p_floor, "toilet");
  ASSERT_TRUE(from_floor_m);
  EXPECT_EQ(context_->DistanceToGoalFromAbout(p_floor, "toilet"), from_floor_m);
  // Outwards, until the mesh does not reach there any more.
  Vector3d p_off = p_floor;
  while (context_->DistanceToGoal(p_off, "toilet")) p_off.x() -= 0.1;
  const auto from_off_m = context_->DistanceToGoalFromAbout(p_off, "toilet");
  ASSERT_TRUE(from_off_m) << p_off.transpose();
  EXPECT_NEAR(*from_off_m, *from_floor_m, 2 * (p_floor - p_off).norm() + 0.5);
  EXPECT_FALSE(context_->DistanceToGoalFromAbout(p_off - Vector3d(50, 0, 0), "toilet"));
}

TEST_F(Runner, TheRecordAgreesWithTheObserver) {
  const Episode episode = ClimbingEpisode();
  Recorder recorder;
  RunObserver* observers[] = {&recorder};
  const auto record = RunEpisode(*context_, episode, ShortConfig(80), observers);
  ASSERT_TRUE(record) << record.error().Message();
  EXPECT_LE(record->actions, 80);
  double length_m = 0;
  int actions = 0;
  for (std::size_t k = 0; k < record->stages.size(); ++k) {
    const StageRecord& stage = record->stages[k];
    length_m += stage.length_m;
    actions += stage.actions;
    EXPECT_EQ(stage.goal, episode.goals[k]);
    EXPECT_NEAR(stage.shortest_m, *context_->DistanceToGoal(stage.start_world, stage.goal), 1e-9);
    if (k > 0) {
      EXPECT_EQ(stage.start_world, record->stages[k - 1].end_world);
    }
  }
  EXPECT_EQ(actions, record->actions);
  // The last step's own displacement happens after it was watched.
  EXPECT_NEAR(length_m, recorder.length_m_, 0.26);
  const Vector3d start = *context_->navmesh().Snap(episode.start.p_world);
  // The foot stands on the surface itself, up to a cell from the navmesh.
  EXPECT_NEAR((record->stages[0].start_world - start).norm(), 0, 0.06);
}

TEST_F(Runner, NextGoalIsRevealedOnlyAfterTheOneBefore) {
  const Episode episode = ClimbingEpisode();
  Recorder recorder;
  RunObserver* observers[] = {&recorder};
  const auto record = RunEpisode(*context_, episode, ShortConfig(80), observers);
  ASSERT_TRUE(record) << record.error().Message();
  std::size_t steps_of_first = 0;
  while (steps_of_first < recorder.goals_.size() && recorder.goals_[steps_of_first] == "sofa") {
    ++steps_of_first;
  }
  EXPECT_EQ(static_cast<int>(steps_of_first), record->stages[0].actions);
  if (record->stages.size() == 1) {
    EXPECT_EQ(steps_of_first, recorder.goals_.size());
  }
}

TEST_F(Runner, BudgetEndsTheEpisodeAndUnexecutedStagesLeaveNoRow) {
  const auto record = RunEpisode(*context_, ClimbingEpisode(), ShortConfig(5));
  ASSERT_TRUE(record) << record.error().Message();
  ASSERT_EQ(record->stages.size(), 1u);
  EXPECT_EQ(record->actions, 5);
  EXPECT_FALSE(record->stages[0].success);
  EXPECT_EQ(ComputeMetrics({&*record, 1}).pr, 0);
}

TEST_F(Runner, StopAtTheObjectOnTheFloorBelowIsNoSuccess) {
  const auto& beds = context_->TargetsOf("bed");
  ASSERT_FALSE(beds.empty());
  const Vector3d p_above = beds[0].viewpoints_world[0];
  EXPECT_TRUE(IsGoalReachedAt(p_above));
  EXPECT_FALSE(IsGoalReachedAt({p_above.x(), p_above.y(), p_above.z() - 2.8}));
}

TEST_F(Runner, StartOffTheNavmeshAndNanAreErrorsThatNameTheKey) {
  Episode off = ClimbingEpisode(), nan = off;
  off.start.p_world = {500, 500, 0};
  nan.start.p_world.x() = std::nan("");
  for (const Episode& bad : {off, nan}) {
    const auto record = RunEpisode(*context_, bad, ShortConfig(5));
    ASSERT_FALSE(record);
    EXPECT_NE(record.error().Message().find("start_position"), std::string::npos);
  }
}

}  // namespace
}  // namespace crossnav::evaluation
