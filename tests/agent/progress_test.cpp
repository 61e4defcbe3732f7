// SPDX-License-Identifier: MIT
// The guarantee of the full profile: in a static world no (standing voxel, heading, target) comes
// up more than a few times without new knowledge of the map in between, and what is left to try
// ends: an agent whose goal does not exist says so.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "agent/two_rooms.h"
#include "crossnav/agent/progress.h"
#include "crossnav/core/rng.h"
#include "support/map_of_states.h"

namespace crossnav::agent {
namespace {

using testing::BoxWalker;
using testing::FakeSuite;
using testing::SmallConfig;

/// Rooms of random boxes: doors, tables to walk under, shelves, gaps of all widths, and seats that
/// look like steps.
BoxWalker RandomHouse(std::uint64_t seed) {
  Rng rng(seed);
  BoxWalker walker;
  walker.sensor = SmallConfig().sensor;
  walker.rooms = crossnav::testing::MakeBoxHouse(seed, rng.Uniform(5, 9), rng.Uniform(4, 8));
  for (int i = 0; i < 3; ++i) {
    const double x = rng.Uniform(0, 4), y = rng.Uniform(0, 3), h = rng.Uniform(0.1, 0.45);
    walker.rooms.solids.push_back(crossnav::testing::BoxOf(x, y, 0, x + 0.6, y + 0.6, h));
  }
  walker.pose = crossnav::testing::RandomStand(rng, walker.rooms, 0);
  return walker;
}

using Moment = std::tuple<int, int, int, int, int>;  // voxel x, y; heading; target x, y

struct Outcome {
  int steps = 0, most_repeats = 0;
  bool all_explored = false;
};

Outcome Explore(std::uint64_t seed, int budget) {
  Agent agent(SmallConfig(), FakeSuite({}));
  EXPECT_TRUE(agent.SetGoal("unicorn").has_value());
  BoxWalker walker = RandomHouse(seed);
  Outcome outcome;
  std::map<Moment, int> moments;
  std::int64_t known = 0;
  for (; outcome.steps < budget; ++outcome.steps) {
    const auto step = agent.Step(walker.Look());
    if (!step) {
      ADD_FAILURE() << step.error().Message();
      return outcome;
    }
    if (step->all_explored) {
      outcome.all_explored = true;
      return outcome;
    }
    const std::int64_t now_known = agent.map().Stats().known;
    if (now_known != known) moments.clear();
    known = now_known;
    const Vector3d p = walker.pose.p_world / 0.1;
    Vector3d target = Vector3d::Constant(-1000);
    for (const auto& candidate : step->trace.candidates)
      if (candidate.is_target) target = candidate.p_focus_world / 0.1;
    const auto cell = [](double v) { return static_cast<int>(std::floor(v)); };
    const int heading = cell(RadToDeg(walker.pose.yaw_rad) / 30 + 0.5);
    const int repeats =
        ++moments[{cell(p.x()), cell(p.y()), heading, cell(target.x()), cell(target.y())}];
    outcome.most_repeats = std::max(outcome.most_repeats, repeats);
    walker.Do(step->action);
  }
  return outcome;
}

// Marks of bumps on all sides of a narrow place closed every way out of it, to the end of the
// budget.
TEST(Progress, AnAgentIsNotWalledInByItsBumps) {
  const Config config = SmallConfig();
  World world(config);
  test::AddGround(world.map, 0, 0, 30, 30, 0);
  world.ground.Rebuild(world.map);
  GoalState goal;
  AgentPose agent;
  agent.p_world = Vector3d(1.55, 1.55, 0);
  const Observation obs;
  const std::vector<policy::Sighting> sightings;
  Situation now{config, world, goal, agent, obs, sightings};
  for (int i = -3; i <= 3; ++i)
    for (const int edge : {-3, 3}) {
      world.ground.Block(agent.p_world + Vector3d(0.1 * i, 0.1 * edge, 0.1));
      world.ground.Block(agent.p_world + Vector3d(0.1 * edge, 0.1 * i, 0.1));
    }
  const auto fail = [&](double x_m) {
    GroundTarget target;
    target.candidate.p_focus_world = Vector3d(x_m, 0, 0);
    Begin(now, ActivityKind::kGoTo, std::move(target));
    End(now, Ending::kNoProgress);
  };
  fail(10);
  EXPECT_TRUE(world.ground.HasBlocked()) << "one way may be closed";
  fail(20);
  EXPECT_FALSE(world.ground.HasBlocked());
}

TEST(Progress, NoStateRecursAndEverySearchEnds) {
  constexpr int kBudget = 3000, kRepeats = 8;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Outcome outcome = Explore(seed, kBudget);
    EXPECT_TRUE(outcome.all_explored) << "house " << seed << " after " << outcome.steps;
    EXPECT_LE(outcome.most_repeats, kRepeats) << "house " << seed;
  }
}

}  // namespace
}  // namespace crossnav::agent
