// SPDX-License-Identifier: MIT
#include "crossnav/agent/agent.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "agent/two_rooms.h"
#include "crossnav/trace/trace_json.h"

namespace crossnav::agent {
namespace {

using crossnav::testing::BoxOf;
using test::BoxWalker;
using test::FakeSight;
using test::FakeSuite;
using testing::BytesOf;
using testing::ClosedRoom;
using testing::CouchSight;
using testing::kCouch;
using testing::RunAgent;
using testing::SmallConfig;
using testing::TwoRooms;
using testing::Walk;
using testing::WorldBytes;

TEST(Agent, FindsTheObjectInTheNextRoomAndStopsWithinRange) {
  Agent agent(SmallConfig(), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  const Walk walk = RunAgent(agent, walker, 400);
  ASSERT_EQ(walk.last_action, Action::kStop) << "after " << walk.traces.size() << " steps";
  EXPECT_LE(kCouch.HorizontalDistance(walker.pose.p_world), 1.30);
  ASSERT_TRUE(walk.p_claimed_world.has_value());
  EXPECT_LT(kCouch.HorizontalDistance(*walk.p_claimed_world), 0.2);
  const auto last = trace::StepTraceFromJson(walk.traces.back());
  ASSERT_TRUE(last.has_value());
  EXPECT_TRUE(last->verification.passed);
}

TEST(Agent, AFixedCameraIsNeverAskedToTilt) {
  Config config = SmallConfig();
  config.action.max_pitch_deg = 0;
  Agent agent(config, FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  walker.pose.pitch_rad = DegToRad(-20);  // pitch of the mounting
  Action action = Action::kTurnLeft;
  for (int i = 0; i < 400 && action != Action::kStop; ++i) {
    const auto result = agent.Step(walker.Look());
    ASSERT_TRUE(result.has_value());
    action = result->action;
    ASSERT_NE(action, Action::kLookUp) << i;
    ASSERT_NE(action, Action::kLookDown) << i;
    walker.Do(action);
  }
  EXPECT_EQ(action, Action::kStop);
  EXPECT_LE(kCouch.HorizontalDistance(walker.pose.p_world), 1.30);
}

TEST(Agent, TellsWhenAClosedRoomWithoutTheGoalIsExplored) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = ClosedRoom();
  const Walk walk = RunAgent(agent, walker, 400);
  EXPECT_TRUE(walk.all_explored) << "after " << walk.traces.size() << " steps";
  EXPECT_NE(walk.last_action, Action::kStop);
  EXPECT_FALSE(walk.p_claimed_world.has_value());
}

TEST(Agent, NeverStopsAtAnObjectOfAnotherCategory) {
  Agent agent(SmallConfig(), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("toilet").has_value());
  BoxWalker walker = TwoRooms();
  const Walk walk = RunAgent(agent, walker, 600);
  EXPECT_TRUE(walk.all_explored) << "after " << walk.traces.size() << " steps";
  EXPECT_NE(walk.last_action, Action::kStop);
}

// A chair seen from 5 m fills too little of the picture to be claimed; it was passed by.
TEST(Agent, ADoubtfulSightingIsGoneNearerToAndNeverClaimed) {
  FakeSight sight = CouchSight();
  const auto detect = sight.detect;
  sight.detect = [detect](const Observation& obs, std::string_view goal) {
    auto found = detect(obs, goal);
    for (auto& detection : found) detection.confidence = 0.45F;
    return found;
  };
  Agent agent(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  const Walk walk = RunAgent(agent, walker, 400);
  EXPECT_FALSE(walk.p_claimed_world.has_value());
  EXPECT_TRUE(std::any_of(walk.traces.begin(), walk.traces.end(), [](const std::string& trace) {
    return trace.find("\"sighting\"") != std::string::npos;
  }));
}

// A network's masks of things far away reach over the rug before them.
TEST(Agent, MasksThatReachOverTheFloorFromAfarDoNotEndTheApproachEarly) {
  FakeSight sight = CouchSight();
  const auto segment = sight.segment;
  sight.segment = [segment](const Observation& obs, perception::Detection& detection) {
    segment(obs, detection);
    if (kCouch.HorizontalDistance(obs.T_world_camera.translation()) < 2.0) return;
    detection.box = {0, 0, obs.rgb.width, obs.rgb.height};
    for (int v = 0; v < obs.rgb.height; ++v)
      for (int u = 0; u < obs.rgb.width; ++u) {
        const Vector3d p =
            obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
        if (p.z() < 0.05 && kCouch.HorizontalDistance(p) < 0.8) detection.mask.At(u, v) = 1;
      }
  };
  Config config = SmallConfig();
  config.sensor.width_px = config.sensor.height_px = 160;  // pixels of the floor touch
  Agent agent(config, FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  walker.sensor = config.sensor;
  const Walk walk = RunAgent(agent, walker, 400);
  ASSERT_EQ(walk.last_action, Action::kStop) << "after " << walk.traces.size() << " steps";
  EXPECT_LE(kCouch.HorizontalDistance(walker.pose.p_world), 1.35);
}

TEST(Agent, AMalformedObservationIsAnErrorThatNamesItsField) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  const Observation good = ClosedRoom().Look();
  const auto where = [&](const Observation& obs) {
    const auto result = agent.Step(obs);
    return result ? std::string() : result.error().where;
  };
  Observation bad = good;
  bad.T_world_camera.translation().x() = std::nan("");
  EXPECT_EQ(where(bad), "observation.T_world_camera");
  bad = good;
  bad.T_world_camera.linear()(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(where(bad), "observation.T_world_camera");
  bad = good;
  bad.T_world_camera.linear() *= 2;
  EXPECT_EQ(where(bad), "observation.T_world_camera");
  bad = good;
  bad.T_world_camera.translation().y() = -3e5;
  EXPECT_EQ(where(bad), "observation.T_world_camera");
  bad = good;
  bad.depth_m = DepthImage(63, 64, 1.0F);
  EXPECT_EQ(where(bad), "observation.depth_m");
  bad = good;
  bad.rgb = RgbImage();
  EXPECT_EQ(where(bad), "observation.depth_m");
  EXPECT_EQ(where(Observation()), "observation.depth_m");
  EXPECT_EQ(agent.map().Stats().known, 0);  // nothing of them got into the map
  EXPECT_EQ(where(good), "");               // the agent continues
}

TEST(Agent, InvalidDepthEverywhereIsNoError) {
  for (const float depth : {0.0F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -1.0F}) {
    Agent agent(SmallConfig(), FakeSuite({}));
    ASSERT_TRUE(agent.SetGoal("bed").has_value());
    Observation obs = ClosedRoom().Look();
    obs.depth_m = DepthImage(64, 64, depth);
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(agent.Step(obs).has_value());
  }
}

TEST(Agent, AFailingNetworkIsAnErrorOfTheStep) {
  for (const std::string part : {"detector", "stairs", "encoder"}) {
    FakeSight sight;
    sight.failing = part;
    Agent agent(SmallConfig(), FakeSuite(sight));
    EXPECT_EQ(agent.SetGoal("bed").has_value(), part != "encoder");
    const auto result = agent.Step(ClosedRoom().Look());
    ASSERT_FALSE(result.has_value()) << part;
    EXPECT_EQ(result.error().where, part);
  }
}

TEST(Agent, ANewGoalLeavesMapAndMemoryAsTheyAre) {
  Agent agent(SmallConfig(), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  RunAgent(agent, walker, 60);
  const WorldBytes before = BytesOf(agent);
  ASSERT_GT(before.states.size(), 1000u);
  ASSERT_GT(before.rows.size(), 100u);
  ASSERT_TRUE(agent.SetGoal("toilet").has_value());
  EXPECT_TRUE(BytesOf(agent) == before);
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  EXPECT_TRUE(BytesOf(agent) == before);
}

int StairMarksOf(const Agent& agent) {
  int marks = 0;
  agent.map().ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel&) {
    marks += agent.map().StairMarkAt(key) != geometry::StairMark::kNone;
  });
  return marks;
}

TEST(Agent, StairMarksSurviveANewGoal) {
  // Boxes stacked like steps in a corner, and a mask that calls them stairs.
  BoxWalker walker = ClosedRoom();
  for (int step = 0; step < 5; ++step)
    walker.rooms.solids.push_back(
        BoxOf(2.4 + 0.3 * step, 2.8, 0, 2.7 + 0.3 * step, 4, 0.18 * (step + 1)));
  FakeSight sight;
  sight.stairs = [](const Observation& obs) {
    Image<float> probability(obs.rgb.width, obs.rgb.height, 0.0F);
    for (int v = 0; v < probability.height; ++v)
      for (int u = 0; u < probability.width; ++u) {
        const Vector3d p =
            obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
        const bool is_stair = p.x() > 2.39 && p.x() < 3.91 && p.y() > 2.79 && p.y() < 3.99 &&
                              p.z() > 0.03 && p.z() < 1.0;
        probability.At(u, v) = is_stair ? 0.9F : 0.0F;
      }
    return probability;
  };
  Config config = SmallConfig();
  config.policy.profile = "paper";  // only its sessions promote
  Agent agent(config, FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  for (int i = 0; i < 150 && StairMarksOf(agent) == 0; ++i) RunAgent(agent, walker, 1);
  const WorldBytes before = BytesOf(agent);
  ASSERT_GT(StairMarksOf(agent), 0);
  ASSERT_TRUE(agent.SetGoal("sofa").has_value());
  EXPECT_TRUE(BytesOf(agent) == before);
}

TEST(Agent, TheFirstGoalIsTheSameWithAndWithoutHistory) {
  std::vector<std::vector<std::string>> traces;
  for (const bool use_history : {true, false}) {
    Config config = SmallConfig();
    config.policy.poi.use_history = use_history;
    Agent agent(config, FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    BoxWalker walker = TwoRooms();
    traces.push_back(RunAgent(agent, walker, 400).traces);
  }
  EXPECT_GT(traces[0].size(), 20u);
  EXPECT_EQ(traces[0], traces[1]);
}

TEST(Agent, ASecondGoalSeenBeforeIsRememberedOnlyWithHistory) {
  for (const bool use_history : {true, false}) {
    Config config = SmallConfig();
    config.policy.poi.use_history = use_history;
    Agent agent(config, FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("toilet").has_value());
    BoxWalker walker = TwoRooms();
    RunAgent(agent, walker, 600);
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    const auto first = agent.Step(walker.Look());
    ASSERT_TRUE(first.has_value());
    const bool is_remembered = first->trace.reason == "goal remembered";
    const bool is_seen = first->trace.reason == "goal seen";
    EXPECT_EQ(is_remembered, use_history) << first->trace.reason;
    EXPECT_FALSE(is_seen);
    walker.Do(first->action);
    const Walk walk = RunAgent(agent, walker, 400);
    EXPECT_TRUE(walk.last_action == Action::kStop || !use_history);
  }
}

TEST(Agent, TheSameObservationsGiveTheSameTracesByteForByte) {
  std::vector<std::vector<std::string>> traces;
  for (int repeat = 0; repeat < 2; ++repeat) {
    Agent agent(SmallConfig(), FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    BoxWalker walker = TwoRooms();
    traces.push_back(RunAgent(agent, walker, 400).traces);
  }
  EXPECT_EQ(traces[0], traces[1]);
}

TEST(Agent, MovesOnlyThroughFreeSpace) {
  Agent agent(SmallConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = TwoRooms();
  int forward = 0, bumps = 0;
  for (int i = 0; i < 200; ++i) {
    const auto result = agent.Step(walker.Look());
    ASSERT_TRUE(result.has_value());
    if (result->all_explored) break;
    const Vector3d before = walker.pose.p_world;
    walker.Do(result->action);
    if (result->action != Action::kMoveForward) continue;
    ++forward;
    bumps += (walker.pose.p_world - before).norm() < 0.01;
  }
  EXPECT_GT(forward, 10);
  EXPECT_LE(10 * bumps, forward);
}

TEST(Agent, AClaimedObjectIsReportedAtItsPlace) {
  Agent agent(SmallConfig(), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  const Walk walk = RunAgent(agent, walker, 300);
  ASSERT_EQ(walk.last_action, Action::kStop);
  const auto last = trace::StepTraceFromJson(walk.traces.back());
  ASSERT_TRUE(last.has_value());
  const auto target = std::find_if(last->candidates.begin(), last->candidates.end(),
                                   [](const trace::CandidateTrace& c) { return c.is_target; });
  ASSERT_NE(target, last->candidates.end());
  EXPECT_LT(kCouch.HorizontalDistance(target->p_nav_world), 0.5);
}

}  // namespace
}  // namespace crossnav::agent
