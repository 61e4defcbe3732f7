// SPDX-License-Identifier: MIT
// The variants no-history-poi and no-history-poi-pure, and the state that a new goal resets. On
// equal observations the variant may differ in History POIs and their consequences (mode, target,
// path, action), and in nothing else. Stairs are left out: they are promoted in sessions only, that
// is, by the agent's actions.
#include <gtest/gtest.h>

#include <algorithm>

#include "agent/two_rooms.h"
#include "crossnav/agent/observation_place.h"
#include "crossnav/policy/frontiers.h"

namespace crossnav::agent {
namespace {

using testing::BoxWalker;
using testing::BytesOf;
using testing::CouchSight;
using testing::FakeSight;
using testing::FakeSuite;
using testing::kCouch;
using testing::RunAgent;
using testing::SmallConfig;
using testing::TwoRooms;
using testing::Walk;
using trace::CandidateTrace;
using trace::StepTrace;

Config WithHistory(bool use_history) {
  Config config = SmallConfig();
  config.policy.poi.use_history = use_history;
  return config;
}

/// One observation, and the goal that was set just before it.
struct ErrandMoment {
  std::string new_goal;
  Observation obs;
};

struct Errand {
  std::string goal;
  int steps;
};

/// Observations of an agent with or without history during the errands.
std::vector<ErrandMoment> Record(bool use_history, const std::vector<Errand>& errands) {
  Agent agent(WithHistory(use_history), FakeSuite(CouchSight()));
  BoxWalker walker = TwoRooms();
  std::vector<ErrandMoment> moments;
  for (const Errand& errand : errands) {
    EXPECT_TRUE(agent.SetGoal(errand.goal).has_value());
    for (int i = 0; i < errand.steps; ++i) {
      moments.push_back({i == 0 ? errand.goal : "", walker.Look()});
      const auto step = agent.Step(moments.back().obs);
      if (!step) {
        ADD_FAILURE() << step.error().Message();
        return moments;
      }
      if (step->all_explored || step->action == Action::kStop) break;
      walker.Do(step->action);
    }
  }
  return moments;
}

std::vector<CandidateTrace> OfKind(const StepTrace& trace, const std::string& kind) {
  std::vector<CandidateTrace> out;
  for (const CandidateTrace& c : trace.candidates)
    if (c.kind == kind) out.push_back(c);
  return out;
}

/// The part of the trace that history must not change: without mode, reason, target, path,
/// verification, events and action, and without candidates of classes that were not requested.
std::string Untouched(StepTrace trace) {
  trace.action = Action::kStop;
  trace.mode = trace.reason = trace.activity = "";
  trace.path_world.clear();
  trace.verification = {};
  trace.events.clear();
  trace.all_explored = false;
  trace.candidates = OfKind(trace, "live_poi");
  for (CandidateTrace& c : trace.candidates) {
    c.is_target = false;
    c.path_cost = -1;
    c.p_nav_world = Vector3d::Zero();
  }
  return ToJson(trace);
}

std::vector<std::vector<geometry::VoxelKey>> FrontiersOf(const Agent& agent, double level_m) {
  const Config& config = agent.config();
  const auto band = policy::BandAround(level_m, config.policy.frontier, config.map.voxel_m);
  std::vector<std::vector<geometry::VoxelKey>> out;
  for (const auto& c : policy::TraversableFrontiers(agent.map(), band, config.policy.frontier,
                                                    config.policy.frontier.min_cluster))
    out.push_back(c.standing);
  return out;
}

struct Differences {
  int with_history = 0, modes = 0, live = 0, frontiers = 0;
};

/// Both variants on the same moments, held against each other after every goal and step.
Differences Compare(const std::vector<ErrandMoment>& moments) {
  Agent with(WithHistory(true), FakeSuite(CouchSight()));
  Agent without(WithHistory(false), FakeSuite(CouchSight()));
  Differences seen;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (!moments[i].new_goal.empty()) {
      EXPECT_TRUE(with.SetGoal(moments[i].new_goal).has_value());
      EXPECT_TRUE(without.SetGoal(moments[i].new_goal).has_value());
      EXPECT_TRUE(BytesOf(with) == BytesOf(without)) << "after the goal of step " << i;
    }
    const auto a = with.Step(moments[i].obs), b = without.Step(moments[i].obs);
    if (!a || !b) {
      ADD_FAILURE() << "step " << i;
      return seen;
    }
    // Every voxel's state is in the trace of each step. A feature that differs once stays
    // different, so that occasional checks suffice.
    if (i % 8 == 0 || i + 1 == moments.size()) {
      EXPECT_TRUE(BytesOf(with) == BytesOf(without)) << "after step " << i;
    }
    const auto frontiers = FrontiersOf(with, a->trace.level_m);
    EXPECT_EQ(frontiers, FrontiersOf(without, b->trace.level_m)) << "after step " << i;
    EXPECT_EQ(Untouched(a->trace), Untouched(b->trace)) << "after step " << i;
    EXPECT_TRUE(OfKind(b->trace, "history_poi").empty());
    seen.with_history += !OfKind(a->trace, "history_poi").empty();
    seen.modes += a->trace.mode != b->trace.mode;
    seen.live += !OfKind(a->trace, "live_poi").empty();
    seen.frontiers += !frontiers.empty();
    if (::testing::Test::HasFailure()) return seen;
  }
  return seen;
}

TEST(HistoryVariant, ChangesNothingButHistoryPoisOnEqualObservations) {
  const std::vector<Errand> errands = {{"toilet", 130}, {"couch", 80}, {"bed", 25}, {"couch", 40}};
  for (const bool driven_by_history : {true, false}) {
    const std::vector<ErrandMoment> moments = Record(driven_by_history, errands);
    ASSERT_GT(moments.size(), 90u);
    const Differences seen = Compare(moments);
    // The comparison saw all that it is about.
    EXPECT_GT(seen.with_history, 0) << driven_by_history;
    EXPECT_GT(seen.modes, 0);
    EXPECT_GT(seen.live, 0);
    EXPECT_GT(seen.frontiers, 2);
  }
}

TEST(HistoryVariant, InspectedGroundIsForgottenUnlessItIsKept) {
  for (const bool keep_coverage : {false, true}) {
    Config config = WithHistory(false);
    config.policy.poi.keep_coverage = keep_coverage;
    Agent agent(config, FakeSuite(CouchSight()));
    BoxWalker walker = TwoRooms();
    ASSERT_TRUE(agent.SetGoal("toilet").has_value());
    ASSERT_TRUE(RunAgent(agent, walker, 600).all_explored);
    ASSERT_TRUE(agent.SetGoal("bed").has_value());
    const auto first = agent.Step(walker.Look());
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(OfKind(first->trace, "uninspected").empty(), keep_coverage);
  }
}

TEST(HistoryVariant, ANewGoalStartsPoisPathAndVerificationAnew) {
  Agent agent(WithHistory(true), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  BoxWalker walker = TwoRooms();
  const Walk walk = RunAgent(agent, walker, 400);
  ASSERT_EQ(walk.last_action, Action::kStop);
  const auto last = trace::StepTraceFromJson(walk.traces.back());
  ASSERT_TRUE(last.has_value());
  ASSERT_TRUE(last->verification.passed);
  ASSERT_FALSE(OfKind(*last, "live_poi").empty());

  // In front of the couch, asked for something else: nothing of the old goal is left.
  ASSERT_TRUE(agent.SetGoal("toilet").has_value());
  const auto other = agent.Step(walker.Look());
  ASSERT_TRUE(other.has_value());
  EXPECT_TRUE(OfKind(other->trace, "live_poi").empty());
  EXPECT_TRUE(OfKind(other->trace, "history_poi").empty());
  EXPECT_FALSE(other->trace.verification.is_active);
  EXPECT_NE(other->trace.mode, last->mode);
  EXPECT_NE(other->trace.path_world.empty() ? Vector3d::Zero() : other->trace.path_world.back(),
            last->path_world.empty() ? Vector3d::Ones() : last->path_world.back());
  EXPECT_NE(other->action, Action::kStop);
  // Live POIs of the old goal are restored with it.
  walker.Do(other->action);
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  const auto back = agent.Step(walker.Look());
  ASSERT_TRUE(back.has_value());
  const auto history = OfKind(back->trace, "history_poi");
  ASSERT_FALSE(history.empty());
  EXPECT_LT(kCouch.HorizontalDistance(history[0].p_focus_world), 0.3);
}

TEST(HistoryVariant, ContrastiveRelevancyReachesTheAgentsRetrieval) {
  std::vector<double> scores;
  for (const char* relevancy : {"cosine", "contrastive"}) {
    Config config = WithHistory(true);
    config.query.relevancy = relevancy;
    Agent agent(config, FakeSuite(CouchSight()));
    ASSERT_TRUE(agent.SetGoal("toilet").has_value());
    BoxWalker walker = TwoRooms();
    RunAgent(agent, walker, 600);
    ASSERT_TRUE(agent.SetGoal("couch").has_value());
    const auto first = agent.Step(walker.Look());
    ASSERT_TRUE(first.has_value());
    const auto history = OfKind(first->trace, "history_poi");
    ASSERT_FALSE(history.empty()) << relevancy;
    EXPECT_LT(kCouch.HorizontalDistance(history[0].p_focus_world), 0.3);
    scores.push_back(history[0].score);
  }
  EXPECT_NE(scores[0], scores[1]);
}

TEST(ObservationPlace, IsWalkableNearAndSeesThePlace) {
  Agent agent(WithHistory(true), FakeSuite(CouchSight()));
  ASSERT_TRUE(agent.SetGoal("toilet").has_value());
  BoxWalker walker = TwoRooms();
  const Vector3d p_start = walker.pose.p_world;
  RunAgent(agent, walker, 600);
  const std::vector<float> text = {1, 0, 0, 0};
  const auto clusters = memory::Query(agent.memory(), text, agent.config().query);
  ASSERT_FALSE(clusters.empty());
  const auto place = FindObservationPlace(agent.map(), clusters[0], p_start, agent.config());
  ASSERT_TRUE(place.has_value());
  EXPECT_LT(kCouch.HorizontalDistance(place->p_foot_world), 2 * 1.30);
  EXPECT_TRUE(walker.IsFree(place->p_foot_world));
  EXPECT_NEAR(place->p_foot_world.z(), 0, 0.1);
  const Vector3d to_couch = kCouch.Center() - place->p_foot_world;
  EXPECT_LT(std::abs(WrapAngle(std::atan2(to_couch.y(), to_couch.x()) - place->yaw_rad)), 0.5);
  // Through the door: longer than the straight line, which a wall crosses.
  EXPECT_GT(place->path_m, (place->p_foot_world - p_start).norm() + 0.5);
  EXPECT_FALSE(FindObservationPlace(agent.map(), clusters[0], Vector3d(50, 50, 0), agent.config()));
}

}  // namespace
}  // namespace crossnav::agent
