// SPDX-License-Identifier: MIT
// A user's decisions in place of the policy's: they are asked, they are obeyed, and with the
// policy's own answers nothing changes.
#include "crossnav/agent/hooks.h"

#include <algorithm>
#include <limits>

#include "agent/storeys.h"
#include "agent/two_rooms.h"

namespace crossnav::agent {
namespace {

using policy::ClaimVerdict;
using testing::ClosedRoom;
using testing::CouchSight;
using testing::FakeSuite;
using testing::RunAgent;
using testing::SmallConfig;
using testing::TwoRooms;
using testing::Walk;

Walk FindCouch(Hooks* hooks, int limit = 300) {
  Agent agent(SmallConfig(), FakeSuite(CouchSight()), hooks);
  EXPECT_TRUE(agent.SetGoal("couch").has_value());
  auto walker = TwoRooms();
  return RunAgent(agent, walker, limit);
}

struct Prefers : Hooks {
  explicit Prefers(std::function<double(const ExplorationOption&)> s) : score(std::move(s)) {}
  std::vector<double> ScoreExploration(const Situation& /*now*/,
                                       std::span<const ExplorationOption> options) override {
    std::vector<double> scores;
    for (const ExplorationOption& option : options) {
      EXPECT_GE(option.path_m, 0);
      scores.push_back(score(option));
    }
    most = std::max(most, options.size());
    return scores;
  }
  std::function<double(const ExplorationOption&)> score;
  std::size_t most = 0;
};

struct Judges : Hooks {
  explicit Judges(std::function<ClaimVerdict(const Claim&)> v) : verdict(std::move(v)) {}
  ClaimVerdict JudgeClaim(const Situation& now, const Claim& claim) override {
    EXPECT_EQ(now.goal.goal, "couch");
    ++asked;
    return verdict(claim);
  }
  std::function<ClaimVerdict(const Claim&)> verdict;
  int asked = 0;
};

std::vector<Action> ActionsOf(const Walk& walk) {
  std::vector<Action> actions;
  for (const std::string& line : walk.traces)
    actions.push_back(trace::StepTraceFromJson(line)->action);
  return actions;
}

TEST(Hooks, OwnAnswersChangeNoAction) {
  Hooks own;
  EXPECT_EQ(ActionsOf(FindCouch(&own)), ActionsOf(FindCouch(nullptr)));
}

// With hooks every candidate is priced, without only candidates that can win. The floor prior of
// both goals is for the other storey.
TEST(Hooks, TheBoundedSearchForTargetsChoosesLikeTheWholeOne) {
  const auto search = [](const std::string& goal, double start_m, Hooks* hooks) {
    Agent agent(SmallConfig(), FakeSuite({}), hooks);
    EXPECT_TRUE(agent.SetGoal(goal).has_value());
    auto walker = testing::TwoStoreys();
    if (start_m > 0) walker.pose.p_world = Vector3d(6.5, 3.0, start_m);
    return ActionsOf(RunAgent(agent, walker, 300));
  };
  Hooks own;
  EXPECT_EQ(search("sofa", 2.8, &own), search("sofa", 2.8, nullptr));
  EXPECT_EQ(search("bed", 0, &own), search("bed", 0, nullptr));
}

TEST(Hooks, TheLeastScoreIsGoneTo) {
  // For any options, the choice is the hook's favourite.
  double best = 0;
  Vector3d p_best_world = Vector3d::Zero();
  Prefers far([&](const ExplorationOption& option) { return -option.path_m; });
  const auto remember = far.score;
  far.score = [&](const ExplorationOption& option) {
    const double score = remember(option);
    if (score < best) p_best_world = option.candidate.p_focus_world;
    best = std::min(best, score);
    return score;
  };
  Agent agent(SmallConfig(), FakeSuite(CouchSight()), &far);
  ASSERT_TRUE(agent.SetGoal("lamp").has_value());
  auto walker = TwoRooms();
  bool is_checked = false;
  for (int i = 0; i < 120 && !is_checked; ++i) {
    best = 0;
    far.most = 0;
    const auto step = agent.Step(walker.Look());
    ASSERT_TRUE(step.has_value());
    if (far.most > 1) {
      const auto& shown = step->trace.candidates;
      const auto target = std::find_if(shown.begin(), shown.end(),
                                       [](const trace::CandidateTrace& c) { return c.is_target; });
      ASSERT_NE(target, shown.end());
      EXPECT_EQ(target->p_focus_world, p_best_world);
      is_checked = true;
    }
    walker.Do(step->action);
  }
  EXPECT_TRUE(is_checked) << "there was never a choice";
}

TEST(Hooks, InfinityIsNever) {
  Prefers none([](const ExplorationOption&) { return std::numeric_limits<double>::infinity(); });
  const Walk walk = FindCouch(&none);
  EXPECT_TRUE(walk.all_explored);
  EXPECT_FALSE(walk.p_claimed_world.has_value());
}

TEST(Hooks, ARefutedClaimIsGivenUp) {
  Judges never([](const Claim&) { return ClaimVerdict::kRefuted; });
  const Walk walk = FindCouch(&never);
  EXPECT_GT(never.asked, 0);
  EXPECT_NE(walk.last_action, Action::kStop);
}

TEST(Hooks, AClaimThatIsBelievedAtOnceStopsAtOnce) {
  Judges at_once([](const Claim&) { return ClaimVerdict::kAgreed; });
  const Walk walk = FindCouch(&at_once), own = FindCouch(nullptr);
  EXPECT_EQ(walk.last_action, Action::kStop);
  ASSERT_EQ(own.last_action, Action::kStop);
  EXPECT_EQ(at_once.asked, 1);
  EXPECT_LT(walk.traces.size(), own.traces.size());
}

}  // namespace
}  // namespace crossnav::agent
