// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_session.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "crossnav/policy/stair_geometry.h"
#include "support/flight_world.h"

namespace crossnav::policy {
namespace {

using geometry::StairMark;
using geometry::VoxelState;
using test::FlightWorld;
using test::MakeFlight;

StairEvidence SeeAll(const VoxelMap& map, const std::vector<VoxelKey>& voxels,
                     float probability = 0.8F) {
  constexpr int kWidth = 32;
  Image<float> mask(kWidth, static_cast<int>(voxels.size()) / kWidth + 2, 0.0F);
  std::vector<geometry::EndRun> ends;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    mask.data[i] = probability;
    ends.push_back({static_cast<std::int32_t>(i), 1, voxels[i]});
  }
  StairEvidence evidence;
  for (int step = 0; step < 3; ++step) evidence.Update(mask, ends, map, {}, step);
  return evidence;
}

/// The flight's voxels with x below `x_m`.
std::vector<VoxelKey> Below(const FlightWorld& world, double x_m) {
  std::vector<VoxelKey> part;
  for (const VoxelKey& key : world.flight)
    if (CenterOf(key, 0.1).x() < x_m) part.push_back(key);
  return part;
}

TEST(PromoteStairs, TakesTheTreadsWithinTheAdmissionRadiusAndNothingElse) {
  FlightWorld world = MakeFlight({.steps = 16});
  const auto evidence = SeeAll(world.map, world.flight);
  const auto first = ColumnTops(Below(world, 0.28));
  StairSession session = BeginSession(+1, 0, {-0.3, 0.5, 0}, first);
  PromoteStairs(session, evidence, world.map, {});
  world.map.UpdateStates();
  int promoted = 0, beyond = 0;
  for (const VoxelKey& key : world.flight) {
    double nearest_m = 1e9;
    for (const VoxelKey& seed : first)
      nearest_m = std::min(nearest_m, 0.1 * VoxelDistance(key, seed));
    const bool is_tread = !IsSurface(world.map.StateAt({key.x, key.y, key.z + 1}));
    const bool is_expected = is_tread && nearest_m <= 2.5 + 1e-9;
    EXPECT_EQ(world.map.StairMarkAt(key) == StairMark::kStair, is_expected)
        << key.x << " " << key.y << " " << key.z;
    EXPECT_EQ(world.map.StateAt(key) == VoxelState::kStair, is_expected);
    promoted += is_expected;
    beyond += is_tread && !is_expected;
  }
  EXPECT_GT(promoted, 100);
  EXPECT_GT(beyond, 50);
}

TEST(PromoteStairs, TheClusterAdvancesUntilTheFlightIsWhole) {
  FlightWorld world = MakeFlight({.steps = 16});
  const auto evidence = SeeAll(world.map, world.flight);
  StairSession session = BeginSession(+1, 0, {-0.3, 0.5, 0}, Below(world, 0.28));
  for (int i = 0; i < 3; ++i) PromoteStairs(session, evidence, world.map, {});
  for (const VoxelKey& key : ColumnTops(world.flight))
    EXPECT_EQ(world.map.StairMarkAt(key), StairMark::kStair);
}

// sec. "Stair-State Promotion": rejected evidence is retained as FAKE_STAIR.
TEST(PromoteStairs, EvidenceWithoutTheShapeOfStairsBecomesFakeStairWithinTheAdmissionRadius) {
  std::set<VoxelKey> floor, air;
  for (int x = 0; x < 45; ++x)
    for (int y = 0; y < 15; ++y) {
      floor.insert({x, y, -1});
      for (int z = 0; z < 15; ++z) air.insert({x, y, z});
    }
  VoxelMap map = test::MapOfEvidence(floor, air);
  const std::vector<VoxelKey> voxels(floor.begin(), floor.end());
  const VoxelKey seed{5, 5, -1};
  StairSession session = BeginSession(+1, 0, {0.5, 0.5, 0}, {seed});
  PromoteStairs(session, SeeAll(map, voxels), map, {});
  map.UpdateStates();
  for (const VoxelKey& key : voxels) {
    const bool is_near = 0.1 * VoxelDistance(key, seed) <= 2.5 + 1e-9;
    EXPECT_EQ(map.StairMarkAt(key), is_near ? StairMark::kFake : StairMark::kNone);
    EXPECT_EQ(map.StateAt({key.x, key.y, key.z + 1}), VoxelState::kTraversable);
  }
}

TEST(PromoteStairs, FakeStairIsReversible) {
  FlightWorld world = MakeFlight({.steps = 6});
  const auto treads = ColumnTops(world.flight);
  StairSession session = BeginSession(+1, 0, {-0.3, 0.5, 0}, Below(world, 0.28));
  StairEvidence poor;
  std::vector<geometry::SeenStair> seen;
  for (const VoxelKey& key : world.flight) seen.push_back({key, 0.8F, 0.64F, false});
  poor.Import(seen);
  PromoteStairs(session, poor, world.map, {});
  for (const VoxelKey& key : treads) EXPECT_EQ(world.map.StairMarkAt(key), StairMark::kFake);
  PromoteStairs(session, SeeAll(world.map, world.flight), world.map, {});
  for (const VoxelKey& key : treads) EXPECT_EQ(world.map.StairMarkAt(key), StairMark::kStair);
}

TEST(PromoteStairs, ADescentDoesNotPromoteAFlightUp) {
  FlightWorld world = MakeFlight();
  StairSession session = BeginSession(-1, 0, {-0.3, 0.5, 0}, Below(world, 0.28));
  PromoteStairs(session, SeeAll(world.map, world.flight), world.map, {});
  for (const VoxelKey& key : world.flight) {
    if (CenterOf(key, 0.1).z() < 0.35) continue;
    EXPECT_EQ(world.map.StairMarkAt(key), StairMark::kNone);
  }
}

TEST(AdvanceSession, ALandingNeedsThreeFlatFramesAwayFromTheEntrance) {
  const FlightWorld world = MakeFlight();
  const Vector3d entrance(-1.0, 0.5, 0), landing(world.end_m + 1.0, 0.5, world.top_m),
      tread(5.5 * 0.28, 0.5, 6 * 0.175);
  StairSession session = BeginSession(+1, 0, entrance, world.flight);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(AdvanceSession(session, world.map, entrance, {}), SessionStatus::kClimbing);
  EXPECT_EQ(session.landing_frames, 0);
  EXPECT_EQ(AdvanceSession(session, world.map, tread, {}), SessionStatus::kClimbing);
  EXPECT_NEAR(session.best_progress_m, 6 * 0.175, 1e-9);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(AdvanceSession(session, world.map, landing, {}), SessionStatus::kClimbing);
  // A step back onto the flight starts the count anew.
  EXPECT_EQ(AdvanceSession(session, world.map, tread, {}), SessionStatus::kClimbing);
  EXPECT_EQ(session.landing_frames, 0);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(AdvanceSession(session, world.map, landing, {}), SessionStatus::kClimbing);
  EXPECT_EQ(AdvanceSession(session, world.map, landing, {}), SessionStatus::kOnLanding);
}

TEST(AdvanceSession, WithoutProgressItStalls) {
  const FlightWorld world = MakeFlight();
  StairSession session = BeginSession(+1, 0, {-1, 0.5, 0}, world.flight);
  StairConfig config;
  config.min_progress_steps = 7;
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(AdvanceSession(session, world.map, {-1, 0.5, 0}, config), SessionStatus::kClimbing);
  EXPECT_EQ(AdvanceSession(session, world.map, {-1, 0.5, 0}, config), SessionStatus::kStalled);
}

TEST(AdvanceSession, GoingDownCountsTheDrop) {
  const FlightWorld world = MakeFlight();
  const Vector3d top(world.end_m + 1, 0.5, world.top_m);
  StairSession session = BeginSession(-1, world.top_m, top, world.flight);
  AdvanceSession(session, world.map, top, {});
  EXPECT_EQ(session.best_progress_m, 0);
  for (int i = 0; i < 2; ++i) AdvanceSession(session, world.map, {-1, 0.5, 0}, {});
  EXPECT_EQ(AdvanceSession(session, world.map, {-1, 0.5, 0}, {}), SessionStatus::kOnLanding);
  EXPECT_NEAR(session.best_progress_m, world.top_m, 1e-9);
}

TEST(StairFrontiers, TheLandingComesFirstThenStepsFromFarToNear) {
  FlightWorld world = MakeFlight();
  const auto evidence = SeeAll(world.map, world.flight);
  StairSession session = BeginSession(+1, 0, {-0.3, 0.5, 0}, Below(world, 0.6));
  for (int i = 0; i < 2; ++i) PromoteStairs(session, evidence, world.map, {});
  world.map.UpdateStates();
  const Vector3d p_foot(-0.3, 0.5, 0);
  const auto frontiers = StairFrontiers(session, world.map, p_foot);
  ASSERT_GT(frontiers.size(), 2u);
  EXPECT_TRUE(std::is_sorted(frontiers.begin(), frontiers.end(),
                             [](const auto& a, const auto& b) { return a.score > b.score; }));
  for (const Candidate& candidate : frontiers) {
    EXPECT_EQ(candidate.kind, CandidateKind::kStairFrontier);
    EXPECT_FALSE(candidate.standing.empty());
    for (const VoxelKey& key : candidate.standing)
      EXPECT_GE((CenterOf(key, 0.1) - p_foot).head<2>().norm(), 0.2);
  }
  EXPECT_GT(frontiers.front().p_focus_world.x(), world.end_m);
  EXPECT_LT(frontiers.back().p_focus_world.x(), world.end_m);
  EXPECT_NEAR(frontiers.front().p_focus_world.z(), world.top_m, 0.15);
}

TEST(StairFrontiers, AreNoneWithoutACluster) {
  EXPECT_TRUE(
      StairFrontiers(BeginSession(1, 0, {0, 0, 0}, {}), MakeFlight().map, {0, 0, 0}).empty());
}

}  // namespace
}  // namespace crossnav::policy
