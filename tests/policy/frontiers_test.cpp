// SPDX-License-Identifier: MIT
#include "crossnav/policy/frontiers.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelState;
using test::AddGround;
using test::SetState;

constexpr double kLevel_m = 0.1;  // top of ground at height index 0
constexpr int kStand = 1;         // height index of the air one stands in

std::vector<Candidate> Frontiers(const VoxelMap& map, int min_cluster = 5) {
  return TraversableFrontiers(map, BandAround(kLevel_m, {}, 0.1), {}, min_cluster);
}
std::vector<Candidate> Drops(const VoxelMap& map) {
  return DescendFrontiers(map, BandAround(kLevel_m, {}, 0.1), {});
}

/// Sets `state` at height `z` in the ring of columns around [0, side) x [0, side).
void AddRing(VoxelMap& map, int side, int z, VoxelState state) {
  for (int i = -1; i <= side; ++i)
    for (const int edge : {-1, side}) {
      SetState(map, {i, edge, z}, state);
      SetState(map, {edge, i, z}, state);
    }
}

/// Ground of 10 x 4 voxels between walls, open at x = 10 only.
VoxelMap Corridor() {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 4, 0);
  for (int z = 0; z <= 15; ++z) {
    for (int x = -1; x <= 10; ++x)
      for (const int y : {-1, 4}) SetState(map, {x, y, z}, VoxelState::kOccupied);
    for (int y = 0; y < 4; ++y) SetState(map, {-1, y, z}, VoxelState::kOccupied);
  }
  return map;
}

TEST(TraversableFrontiers, StandWhereTheGroundMeetsTheUnknown) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 10, 0);
  const auto frontiers = Frontiers(map);
  ASSERT_EQ(frontiers.size(), 1u);
  const Candidate& ring = frontiers.front();
  EXPECT_EQ(ring.kind, CandidateKind::kTraversableFrontier);
  EXPECT_EQ(ring.size, 36);
  ASSERT_EQ(ring.standing.size(), 36u);
  ASSERT_EQ(ring.beyond.size(), 36u);
  for (std::size_t i = 0; i < ring.standing.size(); ++i) {
    const VoxelKey at = ring.standing[i], to = ring.beyond[i];
    EXPECT_EQ(at.z, kStand);
    EXPECT_TRUE(at.x == 0 || at.x == 9 || at.y == 0 || at.y == 9);
    EXPECT_EQ(VoxelDistance(at, to), 1);
    EXPECT_FALSE(map.IsObserved(to));
  }
}

TEST(TraversableFrontiers, AreNoneInsideARoomWithWalls) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 10, 0);
  for (int z = 0; z <= 15; ++z) AddRing(map, 10, z, VoxelState::kOccupied);
  EXPECT_TRUE(Frontiers(map, 1).empty());
}

TEST(TraversableFrontiers, AreNoneWhereTheColumnWasSeenWithinThreeVoxels) {
  for (int dz = -5; dz <= 5; ++dz) {
    VoxelMap map;
    AddGround(map, 0, 0, 10, 10, 0);
    AddRing(map, 10, kStand + dz, VoxelState::kTraversableFake);
    EXPECT_EQ(Frontiers(map).empty(), std::abs(dz) <= 3) << "seen at dz " << dz;
  }
}

TEST(TraversableFrontiers, ASeenSurfaceCountsAsSeen) {
  for (int dz = -3; dz <= 3; ++dz) {
    VoxelMap map;
    AddGround(map, 0, 0, 10, 10, 0);
    AddRing(map, 10, kStand + dz, VoxelState::kOccupied);
    EXPECT_TRUE(Frontiers(map).empty()) << "surface at dz " << dz;
  }
}

TEST(TraversableFrontiers, TheCeilingOfTheStoreyBelowIsNoObservationOfThisOne) {
  for (const int layers : {1, 2}) {
    VoxelMap map;
    AddGround(map, 0, 0, 10, 10, 0);
    // Seen from below: a surface 0.2 m or so under the floor's air, and air underneath it.
    for (int k = 0; k < layers; ++k) AddRing(map, 10, kStand - 2 - k, VoxelState::kOccupied);
    AddRing(map, 10, kStand - 2 - layers, VoxelState::kTraversableFake);
    const auto frontiers = Frontiers(map);
    ASSERT_EQ(frontiers.size(), 1u) << layers << " layers";
    EXPECT_EQ(frontiers.front().size, 36);
  }
}

TEST(TraversableFrontiers, SmallerThanTheMinimumAreLeftOut) {
  const VoxelMap map = Corridor();
  EXPECT_TRUE(Frontiers(map, 5).empty());
  const auto frontiers = Frontiers(map, 4);
  ASSERT_EQ(frontiers.size(), 1u);
  EXPECT_EQ(frontiers.front().size, 4);
  EXPECT_NEAR((frontiers.front().p_focus_world - Vector3d(1.05, 0.2, 0.15)).norm(), 0, 1e-9);
}

TEST(TraversableFrontiers, InflatedVoxelsAreNoStandingPlaces) {
  VoxelMap map = Corridor();
  for (int x = 0; x < 10; ++x)
    for (const int y : {0, 3})
      for (int z = 1; z <= 4; ++z) SetState(map, {x, y, z}, VoxelState::kTraversable, true);
  const auto frontiers = Frontiers(map, 1);
  ASSERT_EQ(frontiers.size(), 1u);
  EXPECT_EQ(frontiers.front().standing, (std::vector<VoxelKey>{{9, 1, 1}, {9, 2, 1}}));
}

TEST(TraversableFrontiers, OfAnotherStoreyAreNotThisLevels) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 10, 28);
  EXPECT_TRUE(Frontiers(map, 1).empty());
  EXPECT_EQ(TraversableFrontiers(map, BandAround(2.9, {}, 0.1), {}, 5).size(), 1u);
}

TEST(TraversableFrontiers, TwoOpenSidesAreTwoCandidatesInOrderOfKeys) {
  VoxelMap map = Corridor();
  for (int z = 0; z <= 15; ++z)
    for (int y = 0; y < 4; ++y) SetState(map, {-1, y, z}, VoxelState::kUnknown);
  const auto frontiers = Frontiers(map, 4);
  ASSERT_EQ(frontiers.size(), 2u);
  EXPECT_EQ(frontiers[0].standing.front(), (VoxelKey{0, 0, 1}));
  EXPECT_EQ(frontiers[1].standing.front(), (VoxelKey{9, 0, 1}));
}

TEST(BandAround, HoldsTheFloorAndOneStepButNotTheNextStorey) {
  const auto band = BandAround(0.1, {}, 0.1);
  EXPECT_TRUE(band.Contains(0));
  EXPECT_TRUE(band.Contains(-2));
  EXPECT_TRUE(band.Contains(3));
  EXPECT_FALSE(band.Contains(5));
  EXPECT_FALSE(band.Contains(-5));
  // A floor exactly on a voxel border may be held by either voxel.
  EXPECT_TRUE(BandAround(0.0, {}, 0.1).Contains(-1));
  EXPECT_TRUE(BandAround(0.0, {}, 0.1).Contains(0));
}

TEST(DescendFrontiers, StandAtADrop) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 4, 0);
  for (int y = 0; y < 4; ++y)
    for (int z = -4; z <= 10; ++z) SetState(map, {10, y, z}, VoxelState::kTraversableFake);
  const auto drops = Drops(map);
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_EQ(drops.front().kind, CandidateKind::kDescendFrontier);
  EXPECT_EQ(drops.front().standing,
            (std::vector<VoxelKey>{{9, 0, 1}, {9, 1, 1}, {9, 2, 1}, {9, 3, 1}}));
  EXPECT_EQ(drops.front().beyond.front(), (VoxelKey{10, 0, 1}));
}

TEST(DescendFrontiers, StandBeforeRejectedStairs) {
  VoxelMap map;
  AddGround(map, 0, 0, 13, 4, 0);
  for (int x = 10; x < 13; ++x)
    for (int y = 0; y < 4; ++y) SetState(map, {x, y, 0}, VoxelState::kFakeStair);
  const auto drops = Drops(map);
  ASSERT_EQ(drops.size(), 1u);
  EXPECT_TRUE(std::find(drops.front().standing.begin(), drops.front().standing.end(),
                        VoxelKey{9, 1, 1}) != drops.front().standing.end());
}

TEST(DescendFrontiers, StandAboveStepsThatWereSeenGoingDown) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 4, 0);
  for (int step = 1; step <= 4; ++step)
    AddGround(map, 7 + 3 * step, 0, 10 + 3 * step, 4, -2 * step);
  const auto drops = Drops(map);
  ASSERT_EQ(drops.size(), 1u);
  // The last step within the level's band, next to the first below it.
  for (const VoxelKey& key : drops.front().standing) {
    EXPECT_EQ(key.x, 15);
    EXPECT_EQ(key.z, -3);
  }
}

TEST(DescendFrontiers, AreNoneOnFlatGroundNorAtItsUnknownBorder) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 10, 0);
  EXPECT_TRUE(Drops(map).empty());
  for (int z = 0; z <= 15; ++z) AddRing(map, 10, z, VoxelState::kOccupied);
  EXPECT_TRUE(Drops(map).empty());
}

TEST(DescendFrontiers, AreNoneAtASingleLowStep) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 4, 0);
  AddGround(map, 10, 0, 20, 4, -2);
  EXPECT_TRUE(Drops(map).empty());
}

TEST(DescendFrontiers, ASingleVoxelIsNone) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 4, 0);
  SetState(map, {10, 2, 1}, VoxelState::kTraversableFake);
  EXPECT_TRUE(Drops(map).empty());
  SetState(map, {10, 1, 1}, VoxelState::kTraversableFake);
  EXPECT_EQ(Drops(map).size(), 1u);
}

}  // namespace
}  // namespace crossnav::policy
