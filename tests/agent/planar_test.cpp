// SPDX-License-Identifier: MIT
// The planar baseline remembers one level, and never leaves it.
#include "crossnav/agent/planar.h"

#include <gtest/gtest.h>

#include "agent/storeys.h"

namespace crossnav::agent {
namespace {

using testing::BoxWalker;
using testing::FakeSight;
using testing::FakeSuite;
using testing::RunAgent;
using testing::SmallConfig;

TEST(Planar, EndVoxelsOfAllFloorsLieOnOneLevel) {
  geometry::EndVoxels ends;
  *ends.runs() = {{7, 2, {1, 2, 3}}, {20, 1, {1, 2, 40}}};
  const auto collapsed = CollapsedOn(2.8, ends, 0.1);
  ASSERT_EQ(collapsed.size(), 2u);
  for (const auto& run : collapsed) EXPECT_EQ(run.key, (geometry::VoxelKey{1, 2, 33}));
  EXPECT_EQ(collapsed[0].pixel, 7);
  EXPECT_EQ(collapsed[0].count, 2);
  EXPECT_EQ(collapsed[1].pixel, 20);
}

TEST(Planar, OneRowAColumnAndNoStairs) {
  BoxWalker walker = testing::TwoStoreys();
  walker.rooms.solids.push_back(testing::kUpperCouch);
  FakeSight sight;
  test::SeeBox(testing::kUpperCouch, "couch", &sight);
  Config config = SmallConfig();
  config.policy.planar = true;
  Agent agent(config, FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const auto walk = RunAgent(agent, walker, 900);
  EXPECT_TRUE(walk.all_explored) << walk.traces.size();
  EXPECT_NEAR(walker.pose.p_world.z(), 0, 0.35);
  ASSERT_GT(agent.memory().Size(), 0);
  for (const auto& key : agent.memory().Keys()) EXPECT_EQ(key.z, agent.memory().Keys()[0].z);
}

}  // namespace
}  // namespace crossnav::agent
