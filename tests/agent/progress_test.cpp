// SPDX-License-Identifier: MIT
// The guarantee of the full profile: in a static world no (standing voxel, heading, target) repeats
// more than a few times without new knowledge of the map in between, and the search ends: an agent
// with an absent goal declares it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "agent/two_rooms.h"
#include "crossnav/agent/act.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/progress.h"
#include "crossnav/agent/pursuit.h"
#include "crossnav/core/rng.h"
#include "support/map_of_states.h"
#include "support/sightings.h"

namespace crossnav::agent {
namespace {

using geometry::VoxelKey;
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

struct WalkOutcome {
  int steps = 0, most_repeats = 0;
  bool all_explored = false;
};

WalkOutcome Explore(std::uint64_t seed, int budget) {
  Agent agent(SmallConfig(), FakeSuite({}));
  EXPECT_TRUE(agent.SetGoal("unicorn").has_value());
  BoxWalker walker = RandomHouse(seed);
  WalkOutcome outcome;
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

/// An agent at (1.52, 1.52) on empty ground.
struct Ground {
  const Config config = SmallConfig();
  World world{config};
  GoalState goal;
  const Observation obs;
  const std::vector<policy::Sighting> sightings;
  StepState now{config, world, goal, {}, {}, obs, sightings};

  Ground() {
    test::AddGround(world.map, 0, 0, 30, 30, 0);
    world.ground.Rebuild(world.map);
    now.agent.p_world = Vector3d(1.52, 1.52, 0);
  }
};

// Regression: on the landing between two flights of one shaft, the path's lower flight counted as
// walked, and the agent followed the ground floor's path on the floor above.
TEST(Progress, APathGoesOnUnderItsOwnFlightOnlyAfterTheFlight) {
  Ground given;
  GoTo go_to;
  const double voxel_m = given.config.map.voxel_m;
  const geometry::VoxelKey start = geometry::KeyOf(given.now.agent.p_world, voxel_m);
  // Down along x, and back below: the last place lies under the first.
  for (int i = 0; i <= 12; ++i) go_to.route.path.push_back(start + geometry::VoxelKey{i, 0, -i});
  for (int i = 11; i >= 0; --i)
    go_to.route.path.push_back(start + geometry::VoxelKey{i, 0, i - 24});
  go_to.target.p_focus_world = CenterOf(go_to.route.path.back(), voxel_m);
  Begin(given.now, std::move(go_to));
  const PathCheck check = CheckPath(given.now);
  EXPECT_TRUE(check.is_near);
  EXPECT_EQ(check.walked, 0U);
}

// Regression: an agent stuck in a narrow gap looked at three remembered places from there, all of
// them on other floors, and counted them as visited without success.
TEST(Progress, ARememberedPlaceThatIsNotReachedIsNotLookedAt) {
  Ground given;
  const geometry::VoxelKey start =
      geometry::KeyOf(given.now.agent.p_world, given.config.map.voxel_m);
  HistoryPoi place;
  place.voxels = {start + geometry::VoxelKey{14, 0, 5}};
  place.p_center_world = CenterOf(place.voxels.front(), given.config.map.voxel_m);
  given.goal.history = {place};
  VisitPlace visit;
  visit.place = 0;
  for (int i = 0; i <= 12; ++i) visit.route.path.push_back(start + geometry::VoxelKey{i, 0, 0});
  for (int i = -3; i <= 3; ++i)
    for (const int edge : {-3, 3}) {
      given.world.ground.Block(given.now.agent.p_world + Vector3d(0.1 * i, 0.1 * edge, 0.1));
      given.world.ground.Block(given.now.agent.p_world + Vector3d(0.1 * edge, 0.1 * i, 0.1));
    }
  Begin(given.now, std::move(visit));
  given.now.agent.pitch_rad = DegToRad(given.config.policy.motion.travel_pitch_deg);
  for (int i = 0; i < 40; ++i) (void)Act(given.now, {});
  EXPECT_EQ(given.goal.history.front().looked, 0);
  EXPECT_FALSE(given.goal.history.front().is_exhausted);
}

// Regression: an approach that a bump stopped counted as a refuted claim. The agent passed the
// television again and again, in plain sight, and said that it was gone.
TEST(Progress, AnApproachThatMadeNoProgressIsTriedFromElsewhere) {
  Ground given;
  const policy::Sighting sighting = test::SightingOfWall({24, 15, 1});
  const policy::ObjectConfig& object = given.config.policy.object;
  for (const int step : {1, 2})
    given.goal.live.Update({sighting}, object, given.config.map.voxel_m, step);
  for (const VoxelKey& key : sighting.voxels)
    test::SetState(given.world.map, key, geometry::VoxelState::kOccupied);
  given.world.ground.Rebuild(given.world.map);
  const auto choose = [&] {
    return ChooseLivePoi(given.now, *given.world.ground.StandingAt(given.now.agent.p_world));
  };
  const Vector3d stuck = given.now.agent.p_world;
  const Vector3d kElsewhere_m[] = {{-0.6, 0.3, 0}, {-0.3, -0.6, 0}, {0, 0.9, 0}};
  for (int tries = 1; tries <= 3; ++tries) {
    auto target = choose();
    ASSERT_TRUE(target) << tries;
    Approach approach;
    approach.poi_id = *target->candidate.poi_id;
    approach.target = target->candidate;
    approach.route.path = target->path;
    Begin(given.now, std::move(approach));
    for (int i = 0; i < 60; ++i) MeasureProgress(given.now);
    EXPECT_FALSE(choose()) << "not from where it stopped";
    given.now.agent.p_world = stuck + kElsewhere_m[tries - 1];
  }
  EXPECT_FALSE(choose()) << "three are enough";
}

// Regression: marks of bumps on all sides of a narrow place closed every exit, to the end of the
// budget.
TEST(Progress, AnAgentIsNotWalledInByItsBumps) {
  Ground given;
  planner::GroundMap& ground = given.world.ground;
  for (int i = -3; i <= 3; ++i)
    for (const int edge : {-3, 3}) {
      ground.Block(given.now.agent.p_world + Vector3d(0.1 * i, 0.1 * edge, 0.1));
      ground.Block(given.now.agent.p_world + Vector3d(0.1 * edge, 0.1 * i, 0.1));
    }
  const auto fail = [&](double x_m) {
    GoTo go_to;
    go_to.target.p_focus_world = Vector3d(x_m, 0, 0);
    Begin(given.now, std::move(go_to));
    End(given.now, Ending::kNoProgress);
  };
  fail(10);
  EXPECT_TRUE(ground.HasBlocked()) << "one way may be closed";
  fail(20);
  EXPECT_FALSE(ground.HasBlocked());
}

// Regression: in a slot between a door leaf and a wall, where the map had no step left, the agent
// turned on the spot to the end of the budget.
TEST(Progress, WithoutAMarkToForgetAStepIsTriedInEveryHeading) {
  Ground given;
  const auto fail = [&](double x_m) {
    GoTo go_to;
    go_to.target.p_focus_world = Vector3d(x_m, 0, 0);
    Begin(given.now, std::move(go_to));
    End(given.now, Ending::kNoProgress);
  };
  fail(10);
  EXPECT_FALSE(IsScanning(given.goal.full.activity));
  fail(20);
  ASSERT_TRUE(IsScanning(given.goal.full.activity));
  const policy::Verification none;
  int turns = 0;
  for (int i = 0; i < 7; ++i) turns += Act(given.now, none) == Action::kTurnLeft;
  EXPECT_EQ(turns, 3) << "a step after each turn";
  given.now.agent.p_world.x() += 0.25;  // the fourth step moved the body
  EXPECT_FALSE(Act(given.now, none).has_value());
  EXPECT_FALSE(IsScanning(given.goal.full.activity));
}

// Regression: between a toilet and a wall three headings were tried in turn for 700 actions,
// because their marks were forgotten each time.
TEST(Progress, WhereMarksWereForgottenAStepIsTriedInEveryHeadingNext) {
  Ground given;
  const auto fail_twice = [&] {
    for (const double x_m : {10, 20}) {
      GoTo go_to;
      go_to.target.p_focus_world = Vector3d(x_m, 0, 0);
      given.world.ground.Block(given.now.agent.p_world + Vector3d(0.3, 0, 0.1));
      Begin(given.now, std::move(go_to));
      End(given.now, Ending::kNoProgress);
    }
  };
  fail_twice();
  EXPECT_FALSE(given.world.ground.HasBlocked());
  EXPECT_FALSE(IsScanning(given.goal.full.activity));
  fail_twice();
  EXPECT_TRUE(IsScanning(given.goal.full.activity));
}

// A body that slid along a door frame marked the middle of the door.
TEST(Progress, ASlidingStepMarksTheObstacleBesideIt) {
  const auto is_open = [](const Vector3d& moved, const VoxelKey& key) {
    Ground given;
    AgentPose before = given.now.agent;  // heads east
    before.p_world -= moved;
    given.world.full.before_forward = before;
    NoteBump(given.now);
    return given.world.ground.IsStanding(key);
  };
  const VoxelKey ahead{16, 15, 1}, aslant{16, 16, 1};
  const Vector3d stopped(0.02, 0, 0), slid(0.12, -0.12, 0);
  EXPECT_FALSE(is_open(stopped, ahead));
  EXPECT_TRUE(is_open(stopped, aslant));
  EXPECT_TRUE(is_open(slid, ahead));
  EXPECT_FALSE(is_open(slid, aslant));
}

TEST(Progress, NoStateRecursAndEverySearchEnds) {
  constexpr int kBudget = 3000, kRepeats = 8;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const WalkOutcome outcome = Explore(seed, kBudget);
    EXPECT_TRUE(outcome.all_explored) << "house " << seed << " after " << outcome.steps;
    EXPECT_LE(outcome.most_repeats, kRepeats) << "house " << seed;
  }
}

}  // namespace
}  // namespace crossnav::agent
