// SPDX-License-Identifier: MIT
#include "crossnav/trace/trace_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crossnav/core/rng.h"
#include "trace/sample_episode.h"

namespace crossnav::trace {
namespace {

StepTrace SmallStep() {
  StepTrace step;
  step.step = 12;
  step.goal_index = 1;
  step.goal = "tv_monitor";
  step.agent.p_world = {0.1, -2, 1e-9};
  step.agent.yaw_rad = 0.5;
  step.T_world_camera.translation() = Vector3d(0.1, -2, 0.88);
  step.action = Action::kTurnLeft;
  step.mode = "basic_explore";
  step.reason = "said \"so\"\n";
  step.activity = "go_to";
  step.candidates.push_back({"live_poi", {1, 2, 3}, {4, 5, 6}, 0.25, -1, 7, true, false});
  step.path_world = {{0, 0, 0}, {1, 0.30000000000000004, 0}};
  step.verification = {true, false, 0.7, 0, 0, 0, 1.5, "distance"};
  geometry::StairFlight flight;
  flight.id = 3;
  flight.p_top_world = {1, 0, 0.5};
  flight.steps_world = {{0, 0, 0}, {1, 0, 0.5}};
  flight.confidence = 0.5;
  flight.walked_up = 1;
  flight.seen_from_world = {{-1, 0, 0}};
  flight.tries = {{{-2, 0, 0}, true, geometry::TryEnding::kNoProgress}};
  step.flights = {flight};
  step.events = {"goal activated: tv_monitor"};
  step.level_m = 2.8;
  step.voxel_changes = {{{-1, 2, 3}, {geometry::VoxelState::kStair, false}},
                        {{4, 5, 6}, {geometry::VoxelState::kTraversable, true}}};
  step.detections = 2;
  step.memory = {900, 80, 7};
  return step;
}

TEST(TraceJson, IsOneCanonicalLine) {
  EXPECT_EQ(ToJson(SmallStep()),
            R"({"step":12,"goal_index":1,"goal":"tv_monitor","agent":{"p_world":[0.1,-2,1e-09],)"
            R"("yaw_rad":0.5,"pitch_rad":0},"T_world_camera":[1,0,0,0.1,0,1,0,-2,0,0,1,0.88],)"
            R"("action":"turn_left","mode":"basic_explore","reason":"said \"so\"\n",)"
            R"("activity":"go_to",)"
            R"("candidates":[{"kind":"live_poi","p_nav_world":[1,2,3],"p_focus_world":[4,5,6],)"
            R"("score":0.25,"path_cost":-1,"size":7,"is_reachable":true,"is_target":false}],)"
            R"("path_world":[[0,0,0],[1,0.30000000000000004,0]],)"
            R"("verification":{"is_active":true,"passed":false,"confidence":0.7,"mask_quality":0,)"
            R"("visibility":0,"view_angle_deg":0,"distance_m":1.5,"failed_check":"distance"},)"
            R"("flights":[{"id":3,"p_foot_world":[0,0,0],"p_top_world":[1,0,0.5],)"
            R"("direction_up":[1,0,0],"steps_world":[[0,0,0],[1,0,0.5]],"confidence":0.5,)"
            R"("walked_up":1,"walked_down":0,"seen_from_world":[[-1,0,0]],)"
            R"("tries":[{"p_from_world":[-2,0,0],"is_up":true,"ending":"no progress"}]}],)"
            R"("events":["goal activated: tv_monitor"],"level_m":2.8,"all_explored":false,)"
            R"("detections":2,"memory":{"rows":900,"compacted_rows":80,"dropped_rows":7},)"
            R"("voxel_changes":[[-1,2,3,5,0],[4,5,6,2,1]]})");
}

TEST(TraceJson, ComesBackWithTheSameBytes) {
  for (const SampleFrame& frame : MakeSampleEpisode(24).frames) {
    const std::string json = ToJson(frame.trace);
    const auto back = StepTraceFromJson(json);
    ASSERT_TRUE(back) << back.error().Message();
    EXPECT_EQ(ToJson(*back), json);
  }
}

TEST(TraceJson, ReadsEveryFieldBack) {
  const auto back = StepTraceFromJson(ToJson(SmallStep()));
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->step, 12);
  EXPECT_EQ(back->goal, "tv_monitor");
  EXPECT_EQ(back->action, Action::kTurnLeft);
  EXPECT_EQ(back->reason, "said \"so\"\n");
  EXPECT_EQ(back->activity, "go_to");
  EXPECT_EQ(back->path_world[1].y(), 0.1 + 0.2);
  EXPECT_EQ(back->candidates[0].size, 7);
  EXPECT_EQ(back->verification.failed_check, "distance");
  EXPECT_EQ(back->flights, SmallStep().flights);
  ASSERT_EQ(back->voxel_changes.size(), 2U);
  EXPECT_EQ(back->voxel_changes[0].key, (geometry::VoxelKey{-1, 2, 3}));
  EXPECT_TRUE(back->voxel_changes[1].voxel.is_inflated);
}

TEST(TraceJson, LeavesVoxelsOutWhenAsked) {
  const std::string json = ToJson(SmallStep(), VoxelText::kOmit);
  EXPECT_EQ(json.find("voxel_changes"), std::string::npos);
  const auto back = StepTraceFromJson(json);
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->voxel_changes.empty());
}

TEST(TraceJson, WritesNumbersThatAreNotFiniteAsNull) {
  StepTrace step = SmallStep();
  step.level_m = std::numeric_limits<double>::quiet_NaN();
  step.candidates[0].score = std::numeric_limits<double>::infinity();
  const std::string json = ToJson(step);
  EXPECT_NE(json.find(R"("level_m":null)"), std::string::npos);
  const auto back = StepTraceFromJson(json);
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_TRUE(std::isnan(back->level_m));
}

TEST(TraceJson, StaysValidForAnyBytesInTexts) {
  StepTrace step = SmallStep();
  for (int c = 1; c < 256; ++c) step.reason += static_cast<char>(c);
  step.goal = "caf\xC3\xA9 \xED\xA0\x80 \xC0\xAF \xF5\x80\x80\x80 \xE2\x82";
  const auto back = StepTraceFromJson(ToJson(step));
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->goal.substr(0, 6), "caf\xC3\xA9 ");
  EXPECT_NE(back->goal.find("\xEF\xBF\xBD"), std::string::npos);
}

TEST(TraceJson, NamesThePathOfAMissingOrWrongKey) {
  const std::string json = ToJson(SmallStep());
  const auto broken = [&](const std::string& what, const std::string& by) {
    std::string text = json;
    text.replace(text.find(what), what.size(), by);
    const auto read = StepTraceFromJson(text);
    return read ? std::string("no error") : read.error().where;
  };
  EXPECT_EQ(broken(R"("score":0.25,)", ""), "candidates[0].score");
  EXPECT_EQ(broken(R"("score":0.25)", R"("score":"high")"), "candidates[0].score");
  EXPECT_EQ(broken(R"("yaw_rad":0.5,)", ""), "agent.yaw_rad");
  EXPECT_EQ(broken("[0,0,0]", "[0,0]"), "path_world[0]");
  EXPECT_EQ(broken("turn_left", "turn_around"), "action");
  EXPECT_EQ(broken(R"("step":12)", R"("step":12.5)"), "step");
  EXPECT_EQ(broken(R"("step":12)", R"("step":99999999999)"), "step");
  EXPECT_EQ(broken("[4,5,6,2,1]", "[4,5,6,8,1]"), "voxel_changes[1]");
  EXPECT_EQ(broken("[4,5,6,2,1]", "[4,5.5,6,2,1]"), "voxel_changes[1]");
  EXPECT_EQ(broken("[4,5,6,2,1]", "[4,null,6,2,1]"), "voxel_changes[1]");
}

TEST(TraceJson, ReadsRecordsFromBeforeTheMemoryWasCounted) {
  std::string json = ToJson(SmallStep());
  const std::string memory = R"("memory":{"rows":900,"compacted_rows":80,"dropped_rows":7},)";
  EXPECT_EQ(StepTraceFromJson(json)->memory.dropped_rows, 7);
  json.erase(json.find(memory), memory.size());
  const auto back = StepTraceFromJson(json);
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->memory.rows, 0);
}

TEST(TraceJson, ReadsRecordsFromBeforeThereWereActivities) {
  std::string json = ToJson(SmallStep());
  const std::string activity = R"("activity":"go_to",)";
  json.erase(json.find(activity), activity.size());
  const auto back = StepTraceFromJson(json);
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->activity, "");
}

TEST(TraceJson, RefusesEveryTruncation) {
  const std::string json = ToJson(SmallStep());
  for (std::size_t n = 0; n < json.size(); ++n) {
    EXPECT_FALSE(StepTraceFromJson(std::string_view(json).substr(0, n))) << n;
  }
}

TEST(TraceJson, SurvivesRandomDamage) {
  const std::string json = ToJson(SmallStep());
  Rng rng(5);
  int errors = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = json;
    text[rng.Below(static_cast<std::uint32_t>(text.size()))] = static_cast<char>(rng.Below(256));
    errors += StepTraceFromJson(text) ? 0 : 1;
  }
  EXPECT_GT(errors, 1000);
}

}  // namespace
}  // namespace crossnav::trace
