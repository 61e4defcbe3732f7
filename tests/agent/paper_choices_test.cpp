// SPDX-License-Identifier: MIT
// policy.profile = paper: the rules of the supplement, and the readings that docs/paper_map.md
// lists under "Choices", each by its effect.
#include <gtest/gtest.h>

#include <algorithm>

#include "agent/storeys.h"
#include "crossnav/agent/paper_behaviour.h"
#include "crossnav/agent/paper_targets.h"
#include "crossnav/policy/frontiers.h"
#include "support/flight_world.h"
#include "support/map_of_states.h"

namespace crossnav::agent::paper {
namespace {

using geometry::VoxelState;
using policy::CandidateKind;
using test::AddGround;
using test::SetState;
using testing::BoxWalker;
using testing::FakeSight;
using testing::FakeSuite;

Config PaperConfig() {
  Config config = testing::SmallConfig();
  config.policy.profile = "paper";
  return config;
}

/// A corridor of 4 m along x whose left end is unknown; `right` is the air beyond its right end.
struct Corridor {
  Config config = PaperConfig();
  World world{config};
  GoalState goal;
  AgentPose agent;

  explicit Corridor(VoxelState right) {
    auto& map = world.map;
    AddGround(map, 0, 0, 40, 6, -1);
    for (int z = -1; z <= 15; ++z)
      for (int x = -1; x <= 40; ++x)
        for (const int y : {-1, 6}) SetState(map, {x, y, z}, VoxelState::kOccupied);
    if (right != VoxelState::kUnknown)
      for (int z = -8; z <= 15; ++z)
        for (int y = 0; y < 6; ++y) SetState(map, {40, y, z}, right);
    agent.p_world = {1.05, 0.3, 0};
    world.step = 100;
  }

  /// Target `steps` after a commitment to a candidate of `kind` at the right end.
  std::optional<Target> ChosenAfter(int steps, CandidateKind kind) {
    Situation now{config, world, goal, agent, agent, std::nullopt, nullptr};
    now.start = planner::StartVoxel(world.map, agent.p_world);
    std::vector<geometry::VoxelKey> standing;
    for (int y = 0; y < 6; ++y) standing.push_back({39, y, 0});
    goal.paper.commitment = Commitment{kind, {4.05, 0.3, 0.05}, standing, world.step - steps, 3};
    std::vector<policy::Candidate> shown;
    return ChooseExploration(now, &shown);
  }
};

// sec. "Candidate Priority": committed for a short grace period.
TEST(PaperCommitment, AFrontierIsKeptForItsGracePeriodAndThenTheNearestIsChosen) {
  Corridor corridor(VoxelState::kUnknown);
  const int grace = corridor.config.policy.frontier.grace_steps;
  const auto kept = corridor.ChosenAfter(grace - 1, CandidateKind::kTraversableFrontier);
  ASSERT_TRUE(kept);
  EXPECT_GT(kept->candidate.p_focus_world.x(), 3);
  EXPECT_EQ(corridor.goal.paper.commitment->arrived_looks, 3);
  const auto fresh = corridor.ChosenAfter(grace, CandidateKind::kTraversableFrontier);
  ASSERT_TRUE(fresh);
  EXPECT_LT(fresh->candidate.p_focus_world.x(), 1);
  EXPECT_EQ(corridor.goal.paper.commitment->arrived_looks, 0);
}

// An ordinary frontier that appears does not call the agent back from an entrance at once.
TEST(PaperCommitment, AnEntranceIsKeptForItsGracePeriodThoughAnOrdinaryFrontierIsThere) {
  Corridor corridor(VoxelState::kTraversableFake);
  const int grace = corridor.config.policy.frontier.grace_steps;
  const auto kept = corridor.ChosenAfter(grace - 1, CandidateKind::kDescendFrontier);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->candidate.kind, CandidateKind::kDescendFrontier);
  const auto fresh = corridor.ChosenAfter(grace, CandidateKind::kDescendFrontier);
  ASSERT_TRUE(fresh);
  EXPECT_EQ(fresh->candidate.kind, CandidateKind::kTraversableFrontier);
}

TEST(PaperCommitment, AFrontierChosenAgainKeepsItsLooks) {
  Corridor corridor(VoxelState::kUnknown);
  corridor.agent.p_world.x() = 3.0;
  ASSERT_TRUE(corridor.ChosenAfter(1000, CandidateKind::kTraversableFrontier));
  EXPECT_EQ(corridor.goal.paper.commitment->since_step, corridor.world.step);
  EXPECT_EQ(corridor.goal.paper.commitment->arrived_looks, 3);
}

// tab:supp_navigation_modes, Target Approach: "rejected detection" ends it.
TEST(PaperModes, ADetectionThatIsRejectedEndsTheApproach) {
  FakeSight sight = testing::CouchSight();
  const auto certain = sight.detect;
  sight.detect = [certain](const Observation& obs, std::string_view goal) {
    auto found = certain(obs, goal);
    const Vector3d eye = obs.T_world_camera.translation();
    if (testing::kCouch.HorizontalDistance(eye) < 1.6)
      for (auto& detection : found) detection.confidence = 0.65F;
    return found;
  };
  Agent agent(PaperConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = testing::TwoRooms();
  const auto walk = testing::RunAgent(agent, walker, 400);
  int rejected = -1;
  for (std::size_t i = 0; i + 1 < walk.traces.size() && rejected < 0; ++i)
    if (walk.traces[i].find("verification failed: confidence") != std::string::npos)
      rejected = static_cast<int>(i);
  ASSERT_GE(rejected, 0) << walk.traces.size();
  const auto at = trace::StepTraceFromJson(walk.traces[static_cast<std::size_t>(rejected)]);
  const auto next = trace::StepTraceFromJson(walk.traces[static_cast<std::size_t>(rejected) + 1]);
  EXPECT_EQ(at->mode, "target_approach");
  EXPECT_EQ(next->mode, "basic_explore");
  EXPECT_EQ(next->reason, "verification failed");
  EXPECT_NE(walk.last_action, Action::kStop);
}

TEST(PaperMap, EndsAtTheBoxOfSixtyMetresAboutTheStart) {
  for (const char* profile : {"paper", "full"}) {
    Config config = PaperConfig();
    config.policy.profile = profile;
    World world(config);
    BoxWalker walker;
    walker.sensor = config.sensor;
    walker.rooms.shell = testing::BoxOf(-2, -2, 0, 34, 2, 3);
    for (const double x : {0.0, 27.0}) {
      walker.pose.p_world = {x, 0, 0};
      const auto obs = walker.Look();
      world.map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    }
    world.UpdateStates();
    int farthest = 0;
    world.map.ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel&) {
      farthest = std::max(farthest, key.x);
    });
    EXPECT_EQ(farthest, profile == std::string("paper") ? 299 : 340) << profile;
  }
}

/// A paper agent in a closed room without its goal.
std::vector<std::string> SearchOfAClosedRoom() {
  Agent agent(PaperConfig(), FakeSuite({}));
  EXPECT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = testing::ClosedRoom();
  const auto walk = testing::RunAgent(agent, walker, 600);
  EXPECT_TRUE(walk.all_explored);
  return walk.traces;
}

TEST(PaperChoices, ASearchBeginsWithOneTurnAndRelaxesOnceBeforeItEnds) {
  const auto traces = SearchOfAClosedRoom();
  ASSERT_GT(traces.size(), 13u);
  EXPECT_EQ(trace::StepTraceFromJson(traces[0])->action, Action::kLookDown);
  for (std::size_t i = 1; i <= 12; ++i)
    EXPECT_EQ(trace::StepTraceFromJson(traces[i])->action, Action::kTurnLeft) << i;
  EXPECT_EQ(std::count_if(traces.begin(), traces.end(),
                          [](const std::string& step) {
                            return step.find("trying once more with relaxed limits") !=
                                   std::string::npos;
                          }),
            1);
}

// Steps that do not move: a forward action into an obstacle that the map does not show.
TEST(PaperChoices, AfterThreeBumpsTheAgentStepsAside) {
  Agent agent(PaperConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = testing::TwoRooms();
  bool is_aside = false;
  for (int i = 0; i < 120 && !is_aside; ++i) {
    const auto step = agent.Step(walker.Look());
    ASSERT_TRUE(step.has_value());
    for (const std::string& event : step->trace.events)
      is_aside |= event == "stuck: stepping aside";
    if (step->action != Action::kMoveForward) walker.Do(step->action);
  }
  EXPECT_TRUE(is_aside);
}

TEST(PaperChoices, TheBodysOwnSpaceIsTraversableFromTheFirstFrame) {
  Agent agent(PaperConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = testing::ClosedRoom();
  ASSERT_TRUE(agent.Step(walker.Look()).has_value());
  const Vector3d p = walker.pose.p_world + Vector3d(0.05, 0.05, 0.05);  // behind the camera's view
  EXPECT_EQ(agent.map().StateAt(geometry::KeyOf(p, 0.1)), VoxelState::kTraversable);
  EXPECT_TRUE(planner::StartVoxel(agent.map(), walker.pose.p_world));
}

// A POI on another floor is reached over known stairs, without a session: the level follows.
TEST(PaperChoices, TheExplorationLevelIsTheOneThatSupportsTheAgent) {
  Agent agent(PaperConfig(), FakeSuite({}));
  ASSERT_TRUE(agent.SetGoal("bed").has_value());
  BoxWalker walker = testing::TwoStoreys();
  testing::RunAgent(agent, walker, 14);
  const auto below = agent.Step(walker.Look());
  ASSERT_TRUE(below.has_value());
  EXPECT_NEAR(below->trace.level_m, 0, 0.05);
  walker.pose.p_world = Vector3d(6.5, 3.0, 2.8);
  double level_m = 0;
  for (int i = 0; i < 14; ++i) {
    const auto step = agent.Step(walker.Look());
    ASSERT_TRUE(step.has_value());
    level_m = step->trace.level_m;
    walker.pose.yaw_rad += DegToRad(30);
  }
  EXPECT_NEAR(level_m, 2.8, 0.05);
}

// With every tread seen, nothing unsupported borders on the floor: only the third condition of a
// descend frontier holds, ground under the level's band.
TEST(PaperChoices, AFlightDownWhoseTreadsWereAllSeenHasADescendFrontier) {
  test::FlightWorld flight = test::MakeFlight();
  flight.map.UpdateStates();
  flight.map.ForEach([](const geometry::VoxelKey&, const geometry::Voxel& voxel) {
    EXPECT_NE(voxel.state, VoxelState::kFakeStair);
  });
  const policy::FrontierConfig config;
  const auto band = policy::BandAround(flight.top_m, config, 0.1);
  EXPECT_FALSE(policy::DescendFrontiers(flight.map, band, config).empty());
}

// tab:supp_configuration, "Descent confirmation": mean of mask probability and geometry score.
TEST(PaperChoices, ADescentIsConfirmedByTheMeanOfMaskAndGeometry) {
  for (const float geometry_score : {0.15F, 0.17F}) {  // with a probability of 0.80: 0.475, 0.485
    const Config config = PaperConfig();
    World world(config);
    test::FlightWorld flight = test::MakeFlight();
    world.map = std::move(flight.map);
    world.UpdateStates();
    std::vector<geometry::SeenStair> seen;
    for (const auto& key : flight.flight) seen.push_back({key, 0.80F, geometry_score, true});
    world.stairs.Import(seen);
    world.level_m = flight.top_m;
    GoalState goal;
    goal.paper.entrance =
        EntranceCheck{CandidateKind::kDescendFrontier, {flight.end_m - 0.4, 0.5, 1.8}, 0, 0};
    AgentPose agent;
    agent.p_world = {flight.end_m + 0.3, 0.5, flight.top_m};
    agent.yaw_rad = DegToRad(180);
    agent.pitch_rad = DegToRad(-60);
    Situation now{config, world, goal, agent, agent, std::nullopt, nullptr};
    std::optional<Action> look;
    EXPECT_EQ(CheckEntrance(now, &look),
              geometry_score > 0.16F ? EntranceVerdict::kVerified : EntranceVerdict::kRejected);
  }
}

}  // namespace
}  // namespace crossnav::agent::paper
