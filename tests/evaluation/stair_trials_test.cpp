// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/stair_trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/world/shell/architecture.h"
#include "evaluation/embedded_house_fixture.h"

namespace crossnav::evaluation {
namespace {

std::string PlainName(std::string_view name) {
  std::string plain(name);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ' '; }, '_');
  return plain;
}

/// The worlds of two seeds, for either form of a stair's name.
template <class Kind>
void ExpectTwoFloorsWithAGoalOnEach(const Kind& kind) {
  for (const std::uint64_t seed : {1, 2}) {
    const auto site = BuildStairSite(MakeStairWorld(kind, seed), test::SmallConfig());
    ASSERT_TRUE(site) << site.error().Message();
    const StairWorld& world = site->world;
    EXPECT_NEAR(world.p_foot_world.z(), world.lower_m, 1e-6);
    EXPECT_NEAR(world.p_top_world.z(), world.upper_m, 1e-6);
    EXPECT_GT(world.upper_m - world.lower_m, 0.4);
    for (const char* goal : {kGoalAbove, kGoalBelow}) {
      ASSERT_EQ(site->context->TargetsOf(goal).size(), 1u) << goal;
      const double floor_m = goal == kGoalAbove ? world.upper_m : world.lower_m;
      EXPECT_NEAR(site->context->TargetsOf(goal)[0].box.min.z(), floor_m, 0.1);
      for (const Vector3d& p_world : {world.p_foot_world, world.p_top_world}) {
        const auto p_start = site->context->navmesh().Snap(p_world);
        ASSERT_TRUE(p_start) << goal;
        EXPECT_TRUE(site->context->DistanceToGoal(*p_start, goal)) << "no way to the " << goal;
      }
    }
  }
}

class EveryStairKind : public testing::TestWithParam<world::StairKind> {};

TEST_P(EveryStairKind, JoinsTwoFloorsWithAGoalOnEach) {
  ExpectTwoFloorsWithAGoalOnEach(GetParam());
}

class EveryStairVariant : public testing::TestWithParam<StairVariant> {};

TEST_P(EveryStairVariant, JoinsTwoFloorsWithAGoalOnEach) {
  ExpectTwoFloorsWithAGoalOnEach(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, EveryStairVariant, testing::ValuesIn(kStairVariants),
                         [](const auto& kind) { return PlainName(kind.param.name); });

INSTANTIATE_TEST_SUITE_P(All, EveryStairKind, testing::ValuesIn(kStairKinds),
                         [](const auto& kind) { return PlainName(world::NameOf(kind.param)); });

class EveryFalseEntrance : public testing::TestWithParam<FalseEntrance> {};

TEST_P(EveryFalseEntrance, LeadsToNoOtherFloor) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const FalseWorld world = MakeFalseWorld(GetParam(), seed);
    const auto context = SceneContext::Of(world::BuildHouse(world.plan), test::SmallConfig());
    ASSERT_TRUE(context) << context.error().Message();
    const sim::NavMesh& navmesh = (*context)->navmesh();
    Rng rng(1);
    std::vector<Vector3d> here, elsewhere;
    for (int i = 0; i < 300; ++i) {
      const auto p = navmesh.RandomPoint(rng);
      ASSERT_TRUE(p);
      const double off_m = std::abs(p->z() - world.start_m);
      if (off_m < 0.1) here.push_back(*p);
      if (off_m > 2.0) elsewhere.push_back(*p);
    }
    ASSERT_FALSE(here.empty()) << "seed " << seed;
    for (const Vector3d& p : elsewhere) {
      EXPECT_FALSE(navmesh.Geodesic(here[0], p)) << "seed " << seed << " to " << p.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryFalseEntrance, testing::ValuesIn(kFalseEntrances),
                         [](const auto& kind) { return PlainName(NameOf(kind.param)); });

// Ground that ends at the edge of a tile of the navmesh leaves a polygon without area in the next
// one. From above, the search for the shortest path went back and forth through it until it gave
// up: this world of `bench stairs` ended the whole run.
TEST(StairTrials, APolygonWithoutAreaIsNoTrapForTheShortestPath) {
  const auto landing = std::ranges::find(kStairVariants, "deep half landing", &StairVariant::name);
  const auto site = BuildStairSite(MakeStairWorld(*landing, 28), RunConfig());
  ASSERT_TRUE(site) << site.error().Message();
  const StairWorld& world = site->world;
  const sim::NavMesh& navmesh = site->context->navmesh();
  const Vector3d before_sofa(2.5, -2.4, world.lower_m);
  const auto down_m = navmesh.Geodesic(world.p_top_world, before_sofa);
  const auto up_m = navmesh.Geodesic(before_sofa, world.p_top_world);
  ASSERT_TRUE(up_m);
  ASSERT_TRUE(down_m);
  EXPECT_NEAR(*down_m, *up_m, 0.05);
}

TEST(StairTrials, TheSameSeedGivesTheSameAttempt) {
  RunConfig config = test::SmallConfig();
  config.eval.action_budget = 30;
  for (const bool goes_up : {true, false}) {
    std::string lines[2];
    for (std::string& line : lines) {
      const auto site = BuildStairSite(world::StairKind::kStraight, 3, config);
      ASSERT_TRUE(site) << site.error().Message();
      const auto attempt = TryStair(*site, goes_up, 3, config);
      ASSERT_TRUE(attempt) << attempt.error().Message();
      EXPECT_EQ(attempt->episode.goals[0], goes_up ? kGoalAbove : kGoalBelow);
      EXPECT_TRUE(attempt->episode.cross_floor_required);
      line = ToJsonLine(attempt->record, /*with_timings=*/false);
    }
    EXPECT_EQ(lines[0], lines[1]);
  }
}

TEST(StairTrials, AnAttemptAtAFalseEntranceEnds) {
  RunConfig config = test::SmallConfig();
  config.eval.action_budget = 20;
  const auto attempt = TryFalseEntrance(FalseEntrance::kFurniture, 1, config);
  ASSERT_TRUE(attempt) << attempt.error().Message();
  EXPECT_LE(attempt->actions, 20);
}

// Regression: a whole `bench stairs` ended there, and its results were lost.
TEST(StairTrials, AWorldWithoutGroundToWalkOnIsPassedOver) {
  RunConfig config = test::SmallConfig();
  config.navmesh.min_island_m2 = 1000;
  const auto attempt = TryFalseEntrance(FalseEntrance::kFurniture, 1, config);
  ASSERT_FALSE(attempt);
  EXPECT_EQ(attempt.error().code, ErrorCode::kNotFound);
}

TEST(WilsonInterval, IsTheTextbooks) {
  const Interval most = WilsonInterval(38, 40), all = WilsonInterval(40, 40);
  EXPECT_NEAR(most.low, 0.8350, 1e-3);
  EXPECT_NEAR(most.high, 0.9862, 1e-3);
  EXPECT_NEAR(all.low, 0.9124, 1e-3);
  EXPECT_DOUBLE_EQ(all.high, 1);
  EXPECT_EQ(WilsonInterval(0, 0).high, 1);
}

}  // namespace
}  // namespace crossnav::evaluation
