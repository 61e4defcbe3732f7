// SPDX-License-Identifier: MIT
// Floors change in small built worlds, with and without a stair mask: geometry leads.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "agent/storeys.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/trace/trace_json.h"

namespace crossnav::agent {
namespace {

using testing::BoxOf;
using testing::BoxWalker;
using testing::FakeSight;
using testing::FakeSuite;
using testing::RunAgent;
using testing::SmallConfig;
using testing::Walk;

/// Finds `couch` in the walker's house, without any stair mask, within `limit` steps.
void ExpectFound(BoxWalker walker, const Box3& couch, int limit) {
  const double start_m = walker.pose.p_world.z();
  walker.rooms.solids.push_back(couch);
  FakeSight sight;
  test::SeeBox(couch, "couch", &sight);
  Agent agent(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const Walk walk = RunAgent(agent, walker, limit);
  EXPECT_EQ(walk.last_action, Action::kStop)
      << "after " << walk.traces.size() << " steps at " << walker.pose.p_world.transpose();
  EXPECT_LE(couch.HorizontalDistance(walker.pose.p_world), 1.3);
  if (std::abs(start_m - walker.pose.p_world.z()) < 2) return;
  ASSERT_EQ(agent.flights().size(), 1u);  // the flight is an object by now
  const auto last = std::find_if(walk.traces.rbegin(), walk.traces.rend(), [](const auto& trace) {
    return trace.find("\"flights\":") != std::string::npos;
  });
  ASSERT_NE(last, walk.traces.rend());
  EXPECT_EQ(trace::StepTraceFromJson(*last)->flights, agent.flights());
  EXPECT_NEAR(agent.flights()[0].p_foot_world.z(), 0, 0.25);
  EXPECT_NEAR(agent.flights()[0].p_top_world.z(), 2.8, 0.25);
}

TEST(FloorChange, AFlightIsClimbedWithoutAnyStairMask) {
  ExpectFound(testing::TwoStoreys(), testing::kUpperCouch, 400);
}

TEST(FloorChange, AFlightIsDescendedWithoutAnyStairMask) {
  BoxWalker walker = testing::TwoStoreys();
  walker.pose.p_world = Vector3d(6.5, 3.0, 2.8);
  ExpectFound(walker, testing::kLowerCouch, 400);
}

// The agent stopped on the treads, from where the object is near and in sight, but a storey below.
TEST(FloorChange, AnObjectBesideTheFlightIsReachedOnItsOwnStorey) {
  const Box3 couch = BoxOf(1.6, 1.2, 0, 2.4, 1.9, 0.7);
  BoxWalker walker = testing::TwoStoreys();
  walker.pose.p_world = Vector3d(6.5, 3.0, 2.8);
  walker.rooms.solids.push_back(couch);
  FakeSight sight;
  test::SeeBox(couch, "couch", &sight);
  Agent agent(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const Walk walk = RunAgent(agent, walker, 500);
  EXPECT_EQ(walk.last_action, Action::kStop);
  EXPECT_NEAR(walker.pose.p_world.z(), 0, 0.5);
}

TEST(FloorChange, OpenRisersAreClimbed) {
  ExpectFound(testing::OpenRisers(), testing::kUpperCouch, 400);
}

TEST(FloorChange, ASplitLevelOfTwoRisersIsTheSameFloor) {
  ExpectFound(testing::SplitLevel(), BoxOf(7.6, 2.6, 0, 8.5, 3.5, 0.7), 300);
}

/// Odometry that is up to 5 cm wrong in height, here too high and there too low.
BoxWalker Drifting(BoxWalker walker) {
  walker.drift_z_m = 0.004;
  return walker;
}

TEST(FloorChange, FloorsAreChangedWithFiveCentimetresOfHeightDrift) {
  ExpectFound(Drifting(testing::TwoStoreys()), testing::kUpperCouch, 400);
  ExpectFound(Drifting(testing::OpenRisers()), testing::kUpperCouch, 400);
  BoxWalker walker = Drifting(testing::TwoStoreys());
  walker.pose.p_world = Vector3d(6.5, 3.0, 2.8);
  ExpectFound(walker, testing::kLowerCouch, 400);
}

// Floors that lie in two layers of voxels must not look like steps, edges or storeys of their own.
TEST(FloorChange, HeightDriftNeitherEndsNorLengthensASearch) {
  const auto search = [](BoxWalker walker) {
    Agent agent(SmallConfig(), FakeSuite({}));
    EXPECT_TRUE(agent.SetGoal("bed").has_value());  // there is none
    return RunAgent(agent, walker, 900);
  };
  const Walk exact = search(testing::TwoStoreys()),
             drifting = search(Drifting(testing::TwoStoreys()));
  EXPECT_TRUE(exact.all_explored);
  EXPECT_TRUE(drifting.all_explored);
  EXPECT_LE(drifting.traces.size(), 1.5 * exact.traces.size());
  const auto level_changes = [](const Walk& walk) {
    return std::count_if(walk.traces.begin(), walk.traces.end(), [](const std::string& step) {
      return step.find("new level") != std::string::npos;
    });
  };
  EXPECT_LE(level_changes(drifting), level_changes(exact) + 2) << "there and back once more";
}

TEST(FloorChange, TheEdgeOfAGalleryIsNoFlightDown) {
  // The flight is walled off at its top: nothing leads down, and the agent says so.
  BoxWalker walker = testing::TwoStoreys();
  walker.rooms.solids.push_back(BoxOf(4.1, 0, 0, 4.2, 1.1, 5.4));
  walker.rooms.solids.push_back(BoxOf(4.1, 1.1, 2.8, 4.2, 1.2, 5.4));
  walker.pose.p_world = Vector3d(6.5, 3.0, 2.8);
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const Walk walk = RunAgent(agent, walker, 900);
  EXPECT_TRUE(walk.all_explored) << "after " << walk.traces.size() << " steps";
  EXPECT_NEAR(walker.pose.p_world.z(), 2.8, 1e-6);
}

// Every return to a level cost a look around of twelve actions.
TEST(FloorChange, ALevelIsLookedAroundOnOnce) {
  BoxWalker walker = testing::TwoStoreys();
  walker.rooms.solids.push_back(testing::kUpperCouch);
  FakeSight sight;
  test::SeeBox(testing::kUpperCouch, "couch", &sight);
  Config config = SmallConfig();
  config.policy.explore.glance_m2 = 1e5;  // no glances: they are scans, too
  Agent agent(config, FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  ASSERT_EQ(RunAgent(agent, walker, 400).last_action, Action::kStop);
  ASSERT_TRUE(agent.SetGoal("bed").has_value());  // there is none
  int looks = 0;
  for (const std::string& step : RunAgent(agent, walker, 600).traces) {
    if (step.find("nothing left") != std::string::npos) break;
    looks += step.find("look_around") != std::string::npos;
  }
  EXPECT_EQ(looks, 0);
}

// The map holds the links of floors: a restored map is used at once.
TEST(FloorChange, ARestoredMemoryKnowsThePathToTheOtherFloor) {
  BoxWalker walker = testing::TwoStoreys();
  walker.rooms.solids.push_back(testing::kUpperCouch);
  FakeSight sight;
  test::SeeBox(testing::kUpperCouch, "couch", &sight);
  sight.text = [](std::string_view) { return std::vector<float>{1, 0, 0, 0}; };
  sight.features = [](const Observation& obs) {
    perception::FeatureGrid grid{8, 8, 4, {}};
    for (int i = 0; i < 64; ++i) {
      const int u = (i % 8) * obs.rgb.width / 8, v = (i / 8) * obs.rgb.height / 8;
      const Vector3d p =
          obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
      const bool is_couch = testing::kUpperCouch.HorizontalDistance(p) < 0.05 && p.z() > 2.85;
      const std::vector<float> cell =
          is_couch ? std::vector<float>{1, 0, 0, 0} : std::vector<float>{0, 0.8F, 0.6F, 0};
      grid.data.insert(grid.data.end(), cell.begin(), cell.end());
    }
    return grid;
  };
  Agent first(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(first.SetGoal("couch").has_value());
  const AgentPose start = walker.pose;
  const Walk search = RunAgent(first, walker, 400);
  ASSERT_EQ(search.last_action, Action::kStop);

  geometry::VoxelMap map = std::move(*geometry::ImportBlocks(ExportBlocks(first.map()), {}));
  map.UpdateStates();
  memory::SemanticMemory memory(first.config().fusion, first.config().map.voxel_m);
  for (std::int64_t row = 0; row < first.memory().Size(); ++row)
    memory.AppendRow(first.memory().RowAt(row));
  Agent second(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(second.Restore(std::move(map), std::move(memory)).has_value());
  ASSERT_TRUE(second.SetGoal("couch").has_value());
  walker.pose = start;
  const Walk again = RunAgent(second, walker, 400);
  EXPECT_EQ(again.last_action, Action::kStop);
  EXPECT_LT(again.traces.size(), search.traces.size());
}

// A flight may lead to a place right below the agent.
TEST(FloorChange, TheEndOfAPathAStoreyBelowIsNotReached) {
  const std::vector<geometry::VoxelKey> path = {{10, 10, 28}, {10, 10, 0}};
  EXPECT_GT(DistanceToEndOf(path, Vector3d(1.05, 1.05, 2.85), 0.1), 2.0);
  EXPECT_LT(DistanceToEndOf(path, Vector3d(1.05, 1.05, 0.2), 0.1), 0.1);
}

}  // namespace
}  // namespace crossnav::agent
