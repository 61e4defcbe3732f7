// SPDX-License-Identifier: MIT
// The guarantee of the full profile: in a static world no (standing voxel, heading, target) comes
// up more than a few times without new knowledge of the map in between, and what is left to try
// ends: an agent whose goal does not exist says so.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "agent/two_rooms.h"
#include "crossnav/core/rng.h"

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
