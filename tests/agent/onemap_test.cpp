// SPDX-License-Identifier: MIT
// The baseline OneMap as an agent: it finds, it remembers, it stays on its floor.
#include <gtest/gtest.h>

#include "agent/storeys.h"

namespace crossnav::agent {
namespace {

using testing::BoxWalker;
using testing::CouchSight;
using testing::FakeSuite;
using testing::RunAgent;
using testing::Walk;

Config OneMapConfig() {
  Config config = testing::SmallConfig();
  config.policy.profile = "onemap";
  config.policy.planar = true;
  config.policy.poi.use_history = false;
  return config;
}

TEST(OneMap, FindsTheObjectInTheNextRoomAndGoesStraightBackToIt) {
  Agent agent(OneMapConfig(), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = testing::TwoRooms();
  const Vector3d p_start = walker.pose.p_world;
  const Walk search = RunAgent(agent, walker, 400);
  ASSERT_EQ(search.last_action, Action::kStop) << search.traces.size();
  EXPECT_LE(testing::kCouch.HorizontalDistance(walker.pose.p_world), 1.3);
  EXPECT_LE(testing::kCouch.HorizontalDistance(*search.p_claimed_world), 0.1);

  // Asked for it again in the first room: its place in the map answers best of all.
  walker.pose.p_world = p_start;
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const auto first = agent.Step(walker.Look());
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->trace.reason, "goal remembered");
  walker.Do(first->action);
  const Walk again = RunAgent(agent, walker, 400);
  EXPECT_EQ(again.last_action, Action::kStop);
  EXPECT_LT(again.traces.size(), search.traces.size());
}

TEST(OneMap, ItCannotChangeFloors) {
  BoxWalker walker = testing::TwoStoreys();
  walker.rooms.solids.push_back(testing::kUpperCouch);
  test::FakeSight sight;
  test::SeeBox(testing::kUpperCouch, "couch", &sight);
  Agent agent(OneMapConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const Walk walk = RunAgent(agent, walker, 400);
  EXPECT_LT(walker.pose.p_world.z(), 0.5);
  for (const std::string& step : walk.traces)
    EXPECT_NEAR(trace::StepTraceFromJson(step)->level_m, 0, 1e-6);
  for (std::int64_t row = 0; row < agent.memory().Size(); ++row)
    EXPECT_EQ(agent.memory().Keys()[static_cast<std::size_t>(row)].z, 5);  // one row a column
}

TEST(OneMap, TheSameObservationsGiveTheSameTraces) {
  std::vector<std::vector<std::string>> traces;
  for (int repeat = 0; repeat < 2; ++repeat) {
    Agent agent(OneMapConfig(), FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    BoxWalker walker = testing::TwoRooms();
    traces.push_back(RunAgent(agent, walker, 60).traces);
  }
  EXPECT_EQ(traces[0], traces[1]);
}

TEST(OneMap, ADetectionAgainstTheMapIsRejected) {
  test::FakeSight sight = CouchSight();
  sight.text = [](std::string_view) { return std::vector<float>{0, 0.8F, 0.6F, 0}; };
  Config config = OneMapConfig();
  config.policy.onemap.consensus_reach_m = 0;  // the floor before the couch answers
  config.policy.onemap.consensus_quantile = 1;
  Agent agent(config, FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = testing::TwoRooms();
  const Walk walk = RunAgent(agent, walker, 200);
  EXPECT_NE(walk.last_action, Action::kStop);
}

}  // namespace
}  // namespace crossnav::agent
