// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/cause.h"

#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/runner.h"
#include "evaluation/embedded_house_fixture.h"
#include "evaluation/record_builder.h"

namespace crossnav::evaluation {
namespace {

const std::vector<sim::Floor> kFloors = {{0, 0.0, 50, {}}, {1, 2.8, 50, {}}, {2, 5.6, 50, {}}};

trace::StepTrace Doing(std::string activity, std::vector<std::string> events = {}) {
  trace::StepTrace step;
  step.mode = "basic_explore";
  step.activity = std::move(activity);
  step.events = std::move(events);
  return step;
}

trace::StepTrace ClimbTo(double z_m) {
  trace::StepTrace step = Doing("climb");
  step.candidates.resize(2);
  step.candidates[0].p_nav_world = {1, 1, -9};  // not the target
  step.candidates[1].p_nav_world = {1, 1, z_m};
  step.candidates[1].is_target = true;
  return step;
}

TEST(CauseWatch, CountsStepsAndKeepsTheLastActivityWithItsEnding) {
  CauseWatch watch(kFloors);
  watch.Add(Doing("look_around", {"goal activated: bed"}), 0);
  for (int i = 0; i < 3; ++i) watch.Add(Doing("go_to"), 0);
  EXPECT_TRUE(watch.Activities().is_under_way);
  EXPECT_EQ(watch.Activities().last_ending, "");
  watch.Add(Doing("none", {"bump", "go_to: no progress"}), 0);
  const StageCause cause = watch.Activities();
  EXPECT_EQ(cause.steps,
            (std::map<std::string, int>{{"look_around", 1}, {"go_to", 3}, {"none", 1}}));
  EXPECT_EQ(cause.last_activity, "go_to");
  EXPECT_EQ(cause.last_ending, "go_to: no progress");
  EXPECT_FALSE(cause.is_under_way);
}

TEST(CauseWatch, AnActivityAfterAnEndingIsInProgress) {
  CauseWatch watch(kFloors);
  watch.Add(Doing("go_to"), 0);
  watch.Add(Doing("climb", {"go_to: unreachable"}), 0);
  EXPECT_EQ(watch.Activities().last_activity, "climb");
  EXPECT_EQ(watch.Activities().last_ending, "go_to: unreachable");
  EXPECT_TRUE(watch.Activities().is_under_way);
}

TEST(CauseWatch, FallsBackToTheModeAndToThePaperProfilesEvents) {
  CauseWatch watch(kFloors);
  watch.Add(Doing("", {"stairs up verified"}), 0);
  watch.Add(Doing("", {"stairs given up"}), 0);
  EXPECT_EQ(watch.Activities().steps, (std::map<std::string, int>{{"basic_explore", 2}}));
  EXPECT_EQ(watch.Activities().last_activity, "basic_explore");
  EXPECT_EQ(watch.Activities().last_ending, "stairs given up");
  EXPECT_TRUE(watch.HasBegun(0, 1));
}

TEST(CauseWatch, AClimbBeginsTheFlightTowardsItsTarget) {
  CauseWatch watch(kFloors);
  watch.Add(ClimbTo(2.8 + 0.4), 1);  // a step within the floor
  EXPECT_FALSE(watch.HasBegun(1, 2) || watch.HasBegun(1, 0));
  watch.Add(ClimbTo(1.6), 1);
  EXPECT_TRUE(watch.HasBegun(1, 0));
  EXPECT_FALSE(watch.HasBegun(1, 2));
  EXPECT_FALSE(watch.HasBegun(2, 0));
  watch.Arrive(1, 0);
  EXPECT_TRUE(watch.HasClimbed(1, 0));
  EXPECT_FALSE(watch.HasClimbed(0, 1));
}

TEST(NextFloor, IsTheFirstHopToTheNearestFloorOfTheGoal) {
  const std::vector<sim::FloorConnection> links = {{0, 1, 2.8}, {1, 2, 2.8}};
  EXPECT_EQ(NextFloor(links, 0, {2}), std::pair(1, 2));
  EXPECT_EQ(NextFloor(links, 2, {0, 1}), std::pair(1, 1));
  EXPECT_EQ(NextFloor(links, 1, {1, 2}), std::nullopt);
  EXPECT_EQ(NextFloor(links, 0, {7}), std::nullopt);
}

TEST(SeenShare, IsTheShareOfPointsWithGroundNearThem) {
  geometry::VoxelMap map;
  map.ObserveBody({1.05, 1.05, 0}, 0.88);  // supports the foot, and nothing else
  map.UpdateStates();
  const std::vector<Vector3d> walkable = {
      {1.05, 1.05, 0.05}, {1.05, 1.05, 2.8}, {3.05, 1.05, 0}, {1.05, 5.05, 0}};
  EXPECT_TRUE(HoldsGround(map, walkable[0]));
  EXPECT_DOUBLE_EQ(SeenShare(map, walkable), 0.25);
  EXPECT_DOUBLE_EQ(SeenShare(map, {}), 0);
}

TEST(HoldsFlight, LooksBetweenTheFloorsOnly) {
  geometry::VoxelMap map;
  std::vector<Vector3d> walkable;
  for (int i = 0; i <= 14; ++i) walkable.emplace_back(1.05, 0.05 + 0.3 * i, 0.2 * i);
  for (int i = 0; i < 4; ++i) map.ObserveBody(walkable[static_cast<std::size_t>(i)], 0.88);
  map.UpdateStates();
  EXPECT_FALSE(HoldsFlight(map, walkable, 0, 2.8));  // its foot belongs to the floor
  for (int i = 4; i < 7; ++i) map.ObserveBody(walkable[static_cast<std::size_t>(i)], 0.88);
  map.UpdateStates();
  EXPECT_TRUE(HoldsFlight(map, walkable, 0, 2.8));
  EXPECT_TRUE(HoldsFlight(map, walkable, 2.8, 0));
  EXPECT_FALSE(HoldsFlight(map, walkable, 2.8, 5.6));
}

/// One failed stage.
EpisodeRecord FailedEpisode(Outcome outcome, const StageCause& cause) {
  EpisodeRecord episode = test::MakeEpisode("house-f42", 1, {{false, 1, 2}});
  StageRecord& stage = episode.stages[0];
  stage.goal = episode.goals[0] = "bed";
  stage.outcome = outcome;
  stage.actions = 1200;
  stage.extra.cause = cause;
  return episode;
}

const StageCause kLost = {{{"climb", 40}, {"go_to", 800}, {"look_around", 120}},
                          "go_to",
                          false,
                          "go_to: no progress",
                          FlightCause{2, 2, true, false, false},
                          0.639};

TEST(CauseLines, DescribeAFailedStageInOneLine) {
  EXPECT_EQ(CauseLines(FailedEpisode(Outcome::kOutOfTime, kLost)),
            std::vector<std::string>{
                "house-f42: bed out_of_time after 1200 | last go_to, ended: no progress | "
                "flight to floor 2 seen, never begun | 63 % of the walkable area seen | "
                "steps: go_to 800 look_around 120 climb 40"});
  StageCause other = kLost;
  other.is_under_way = true;
  other.last_activity = "climb";
  other.flight = FlightCause{1, 2, true, true, false};
  const std::string line = CauseLines(FailedEpisode(Outcome::kStuck, other))[0];
  EXPECT_NE(line.find("| last climb, under way (before: go_to: no progress) | flight to floor 1 on "
                      "the way to 2 begun, never climbed |"),
            std::string::npos)
      << line;
}

TEST(CauseLines, AreNoneForSuccessesAndForOldRecords) {
  EXPECT_TRUE(CauseLines(test::MakeEpisode("a", 1, {{true, 1, 1}})).empty());
  EXPECT_TRUE(CauseLines(test::MakeEpisode("a", 1, {{false, 1, 1}})).empty());
}

TEST(CauseOf, NamesTheFirstThingThatWentWrong) {
  const auto cause_of = [](Outcome outcome, const StageCause& cause, bool has_passed = false) {
    StageRecord stage = FailedEpisode(outcome, cause).stages[0];
    stage.extra.passed_target = has_passed;
    return CauseOf(stage);
  };
  EXPECT_EQ(cause_of(Outcome::kMisdetection, kLost), "stopped at the wrong object");
  EXPECT_EQ(cause_of(Outcome::kNotReached, kLost), "stopped too far away");
  EXPECT_EQ(cause_of(Outcome::kStuck, kLost, true), "passed the goal");
  EXPECT_EQ(cause_of(Outcome::kStuck, kLost), "flight seen, never begun");
  StageCause cause = kLost;
  cause.flight->climbed = true;
  EXPECT_EQ(cause_of(Outcome::kStuck, cause), "flight climbed and left again");
  cause.flight->floor = 0;  // where the stage ended: the goal's floor was reached
  EXPECT_EQ(cause_of(Outcome::kStuck, cause), "go_to: no progress");
  cause.flight.reset();
  cause.is_under_way = true;
  EXPECT_EQ(cause_of(Outcome::kOutOfTime, cause), "go_to under way");
  StageRecord old = FailedEpisode(Outcome::kStuck, cause).stages[0];
  old.extra.cause.reset();
  EXPECT_EQ(CauseOf(old), "unknown");
  old.success = true;
  EXPECT_EQ(CauseOf(old), "");
}

TEST(CountCauses, CountsFailedStagesByOutcomeWithTheirMeanShare) {
  StageCause more = kLost;
  more.seen_share = 0.839;
  const std::vector<EpisodeRecord> episodes = {FailedEpisode(Outcome::kOutOfTime, kLost),
                                               FailedEpisode(Outcome::kStuck, more),
                                               test::MakeEpisode("a", 1, {{true, 1, 1}})};
  const auto counts = CountCauses(episodes);
  ASSERT_EQ(counts.size(), 1u);
  const CauseCount& count = counts.at("flight seen, never begun");
  EXPECT_EQ(count.stages, 2);
  EXPECT_EQ(count.outcomes[static_cast<std::size_t>(Outcome::kStuck)], 1);
  EXPECT_NEAR(count.seen_share, 0.739, 1e-12);
}

class CauseOfARun : public test::EmbeddedHouseTest {};

TEST_F(CauseOfARun, WalkablePointsCoverTheNavmesh) {
  const auto& points = context_->WalkablePoints();
  const double area_m2 = static_cast<double>(points.size()) * 0.2 * 0.2;
  EXPECT_NEAR(area_m2, context_->navmesh().AreaM2(), 0.1 * context_->navmesh().AreaM2());
  EXPECT_EQ(&context_->WalkablePoints(), &points);
}

TEST_F(CauseOfARun, ARunThatEndsAtOnceHasSeenLittleAndNoFlight) {
  RunConfig config = test::SmallConfig();
  config.eval.action_budget = 3;
  const auto episode = MakeEpisode({scene_id_, context_.get()}, config, {"bed"}, 0, 1);
  ASSERT_TRUE(episode) << episode.error().Message();
  const auto record = RunEpisode(*context_, *episode, config);
  ASSERT_TRUE(record) << record.error().Message();
  const auto& cause = record->stages.at(0).extra.cause;
  ASSERT_TRUE(cause);
  EXPECT_EQ(cause->steps, (std::map<std::string, int>{{"look_around", 3}}));
  EXPECT_EQ(cause->last_activity, "look_around");
  EXPECT_GT(cause->seen_share, 0);
  EXPECT_LT(cause->seen_share, 0.5);
  ASSERT_TRUE(cause->flight);
  EXPECT_EQ(cause->flight->floor, 1);
  EXPECT_FALSE(cause->flight->begun || cause->flight->climbed);
}

}  // namespace
}  // namespace crossnav::evaluation
