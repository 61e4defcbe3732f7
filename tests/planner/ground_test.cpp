// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_map.h"
#include "crossnav/planner/ground_search.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "support/flight_world.h"
#include "support/ground_of.h"
#include "support/map_of_states.h"

namespace crossnav::planner {
namespace {

using geometry::VoxelMap;
using geometry::VoxelState;
using test::AddGround;
using test::GroundOf;
using test::SetState;

/// Whatever `Next` gives, in order.
std::map<VoxelKey, double> CostsFrom(const GroundMap& ground, const VoxelKey& start) {
  const PlannerConfig config;
  GroundSearch search(ground, config, start);
  std::map<VoxelKey, double> costs;
  double last = 0;
  while (const auto key = search.Next()) {
    EXPECT_GE(search.cost(), last);
    last = search.cost();
    costs[*key] = last;
  }
  return costs;
}

void AddColumn(VoxelMap& map, int x, int y, int z0, int z1) {
  for (int z = z0; z <= z1; ++z) SetState(map, {x, y, z}, VoxelState::kOccupied);
}

TEST(GroundMap, APlaceIsASurfaceWithAirAndHeadRoom) {
  VoxelMap map;
  AddGround(map, 0, 0, 6, 6, 0);
  SetState(map, {2, 2, 8}, VoxelState::kOccupied);   // a shelf at 0.8 m
  SetState(map, {3, 3, 15}, VoxelState::kOccupied);  // a lintel just above the head
  const GroundMap ground = GroundOf(map);
  EXPECT_TRUE(ground.IsStanding({1, 1, 1}));
  EXPECT_FALSE(ground.IsStanding({1, 1, 2}));
  EXPECT_FALSE(ground.IsStanding({2, 2, 1}));
  EXPECT_TRUE(ground.IsStanding({3, 3, 1}));
}

// Window seats of `bench stairs`: the wall was seen up to a slanting line, and the rays along it
// left one voxel of air above, which made stairs of it.
TEST(GroundMap, ARayAlongAWallMakesNoGround) {
  VoxelMap map;
  AddGround(map, 0, 0, 8, 3, 0);
  for (int x = 0; x < 8; ++x) {  // at y = 3 seen up to a line that rises like a stair
    AddColumn(map, x, 3, 0, 2 + x / 2);
    SetState(map, {x, 3, 3 + x / 2}, VoxelState::kTraversable);
  }
  EXPECT_FALSE(GroundOf(map).IsStanding({0, 3, 3}));
  EXPECT_FALSE(CostsFrom(GroundOf(map), {1, 1, 1}).contains({7, 3, 6}));
  for (int x = 0; x < 8; ++x)  // seen as air, it is ground: steps along the wall
    SetState(map, {x, 3, 4 + x / 2}, VoxelState::kTraversable);
  EXPECT_TRUE(CostsFrom(GroundOf(map), {1, 1, 1}).contains({7, 3, 6}));
}

TEST(GroundMap, TellsGroundWallsDropsAndTheUnseen) {
  VoxelMap map;
  AddGround(map, 0, 0, 3, 1, 0);
  AddColumn(map, 0, 1, 0, 15);    // a wall
  AddGround(map, 1, 1, 2, 2, 3);  // a step of 0.3 m
  AddGround(map, 2, 1, 3, 2, 4);  // a bench of 0.4 m
  for (int z = -8; z <= 10; ++z) SetState(map, {3, 0, z}, VoxelState::kTraversableFake);  // a drop
  for (int z = 0; z <= 10; ++z)
    SetState(map, {0, -1, z}, VoxelState::kTraversableFake);  // air, the floor below hidden
  const GroundMap ground = GroundOf(map);
  int z = 0;
  EXPECT_EQ(ground.OutcomeOf({0, 0, 1}, 0, 1, &z), StepOutcome::kBlocked);
  EXPECT_EQ(ground.OutcomeOf({1, 0, 1}, 0, 1, &z), StepOutcome::kGround);
  EXPECT_EQ(z, 4);
  EXPECT_EQ(ground.OutcomeOf({2, 0, 1}, 0, 1, &z), StepOutcome::kBlocked);
  EXPECT_EQ(ground.OutcomeOf({2, 0, 1}, 1, 0, &z), StepOutcome::kDrop);
  EXPECT_EQ(ground.OutcomeOf({0, 0, 1}, 0, -1, &z), StepOutcome::kUnknown);
  EXPECT_EQ(ground.OutcomeOf({1, 0, 1}, 0, -1, &z), StepOutcome::kUnknown);
}

// Open risers: light falls below a tread whose top hides behind its edge (found in generated U
// stairs, where the flight ended one metre up).
TEST(GroundMap, ATreadThatHidesBetweenSeenAirIsUnseenGroundAndIsBridged) {
  VoxelMap map;
  AddGround(map, 0, 0, 3, 3, 0);
  for (int x = 3; x < 6; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = -4; z <= 15; ++z) {
        if (z == 1) continue;  // where the tread is
        SetState(map, {x, y, z}, VoxelState::kTraversableFake);
      }
  AddGround(map, 6, 0, 9, 3, 3);
  const GroundMap ground = GroundOf(map);
  int z = 0;
  EXPECT_EQ(ground.OutcomeOf({2, 1, 1}, 1, 0, &z), StepOutcome::kUnknown);
  EXPECT_EQ(ground.Bridge({2, 1, 1}, 1, 0, 4), (VoxelKey{6, 1, 4}));
  EXPECT_FALSE(ground.Bridge({2, 1, 1}, 1, 0, 3));
  EXPECT_TRUE(CostsFrom(ground, {0, 1, 1}).contains({8, 1, 4}));
}

// The ceiling of the storey underneath, 0.3 m below a floor that was not seen yet, walled in the
// top of a flight (house 1).
TEST(GroundMap, TheCeilingOfTheStoreyBelowIsNoWall) {
  VoxelMap map;
  AddGround(map, 0, 0, 3, 3, 0);
  for (int x = 3; x < 8; ++x)
    for (int y = 0; y < 3; ++y) SetState(map, {x, y, -3}, VoxelState::kOccupied);
  const GroundMap ground = GroundOf(map);
  int z = 0;
  EXPECT_EQ(ground.OutcomeOf({2, 1, 1}, 1, 0, &z), StepOutcome::kUnknown);
}

// The last riser below a landing, seen from below: the tread behind it is not (house 16).
TEST(GroundMap, ARiserWithoutSeenAirAboveIsUnseenGround) {
  VoxelMap map;
  AddGround(map, 0, 0, 3, 3, 0);
  for (int y = 0; y < 3; ++y)
    for (const int z : {1, 2}) SetState(map, {3, y, z}, VoxelState::kOccupied);
  AddGround(map, 4, 0, 6, 3, 2);
  const GroundMap ground = GroundOf(map);
  int z = 0;
  EXPECT_EQ(ground.OutcomeOf({2, 1, 1}, 1, 0, &z), StepOutcome::kUnknown);
  EXPECT_EQ(ground.Bridge({2, 1, 1}, 1, 0, 4), (VoxelKey{4, 1, 3}));
}

TEST(GroundMap, NoBridgeLeadsThroughAWallOrOverAStoreysDrop) {
  VoxelMap map;
  AddGround(map, 0, 0, 3, 3, 0);
  AddGround(map, 5, 0, 8, 3, 0);
  for (int y = 0; y < 3; ++y) AddColumn(map, 4, y, 0, 12);
  EXPECT_FALSE(GroundOf(map).Bridge({2, 1, 1}, 1, 0, 4));
  VoxelMap void_between;
  AddGround(void_between, 0, 0, 3, 3, 0);
  AddGround(void_between, 9, 0, 12, 3, 0);
  EXPECT_FALSE(CostsFrom(GroundOf(void_between), {0, 1, 1}).contains({10, 1, 1}));
}

TEST(GroundMap, AGapOfOneColumnIsAPinch) {
  VoxelMap map;
  AddGround(map, 0, 0, 9, 5, 0);
  for (int z = 0; z <= 12; ++z)
    for (const int y : {0, 1, 3, 4}) SetState(map, {4, y, z}, VoxelState::kOccupied);
  const GroundMap ground = GroundOf(map);
  EXPECT_EQ(ground.ClearanceOf({4, 2, 1}), Clearance::kPinch);
  EXPECT_EQ(ground.ClearanceOf({3, 2, 1}), Clearance::kTouch);
  EXPECT_EQ(ground.ClearanceOf({2, 2, 1}), Clearance::kTight);
  EXPECT_EQ(ground.ClearanceOf({1, 2, 1}), Clearance::kFree);
}

TEST(GroundMap, ABumpedColumnIsNoGroundUntilForgotten) {
  VoxelMap map;
  AddGround(map, 0, 0, 5, 5, 0);
  GroundMap ground = GroundOf(map);
  const auto before = ground.revision();
  ground.Block({0.25, 0.25, 0.1});
  EXPECT_FALSE(ground.IsStanding({2, 2, 1}));
  EXPECT_GT(ground.revision(), before);
  ground.ForgetBlocked();
  EXPECT_TRUE(ground.IsStanding({2, 2, 1}));
}

TEST(GroundMap, OnlyBumpsNearByAreForgotten) {
  VoxelMap map;
  AddGround(map, 0, 0, 30, 5, 0);
  GroundMap ground = GroundOf(map);
  ground.Block({0.25, 0.25, 0.1});
  ground.Block({2.25, 0.25, 0.1});
  EXPECT_TRUE(ground.ForgetBlockedAround({0.5, 0.25, 0.1}, 1));
  EXPECT_TRUE(ground.IsStanding({2, 2, 1}));
  EXPECT_FALSE(ground.IsStanding({22, 2, 1}));
  EXPECT_FALSE(ground.ForgetBlockedAround({0.5, 0.25, 0.1}, 1));
}

TEST(GroundMap, ChangesEqualARebuild) {
  Rng rng(3);
  VoxelMap map;
  GroundMap changed(map.config());
  for (int i = 0; i < 4000; ++i) {
    const VoxelKey key{rng.Int(-9, 9), rng.Int(-9, 9), rng.Int(-70, 70)};
    const auto state = rng.Chance(0.5) ? VoxelState::kOccupied : VoxelState::kTraversable;
    SetState(map, key, state);
    changed.Update({{key, {state, false}}});
  }
  const GroundMap rebuilt = GroundOf(map);
  for (int x = -10; x <= 10; ++x)
    for (int y = -10; y <= 10; ++y)
      for (int z = -72; z <= 72; ++z) {
        const VoxelKey key{x, y, z};
        ASSERT_EQ(changed.IsStanding(key), rebuilt.IsStanding(key));
        const bool is_supported =
            IsSurface(map.StateAt({x, y, z - 1})) && map.StateAt(key) == VoxelState::kTraversable;
        ASSERT_TRUE(is_supported || !rebuilt.IsStanding(key));
      }
}

TEST(GroundSearch, WalksAFlightInBothDirectionsWithoutAnyStairMark) {
  test::FlightWorld world = test::MakeFlight();
  world.map.UpdateStates();
  const GroundMap ground = GroundOf(world.map);
  const auto foot = ground.StandingAt({-1, 0.5, 0});
  const auto top = ground.StandingAt({world.end_m + 1, 0.5, world.top_m});
  ASSERT_TRUE(foot && top);
  EXPECT_TRUE(CostsFrom(ground, *foot).contains(*top));
  EXPECT_TRUE(CostsFrom(ground, *top).contains(*foot));
}

// Ottomans and couches of `bench stairs`: the front of a seat, lower by a rounded edge.
TEST(GroundSearch, TheFrontOfASeatIsNoTread) {
  VoxelMap map;
  AddGround(map, 0, 0, 4, 4, 0);
  AddGround(map, 4, 0, 5, 4, 3);
  AddGround(map, 5, 0, 8, 4, 4);
  EXPECT_FALSE(CostsFrom(GroundOf(map), {1, 1, 1}).contains({6, 1, 5}));
  VoxelMap stair;  // as high, but the first step can be stood on
  AddGround(stair, 0, 0, 4, 4, 0);
  AddGround(stair, 4, 0, 6, 4, 2);
  AddGround(stair, 6, 0, 8, 4, 4);
  EXPECT_TRUE(CostsFrom(GroundOf(stair), {1, 1, 1}).contains({6, 1, 5}));
}

/// Least clearance of an oblique step over four level places, both its orders; nullopt where it is
/// none.
std::optional<Clearance> ObliqueRoom(const GroundMap& ground, const VoxelKey& from, int dx,
                                     int dy) {
  if (std::abs(dx * dy) != 2) return std::nullopt;
  const int sx = dx > 0 ? 1 : -1, sy = dy > 0 ? 1 : -1;
  const int ax = dx - sx, ay = dy - sy;  // the step along an axis
  const VoxelKey beside{from.x + ax, from.y + ay, from.z};
  const VoxelKey ahead{from.x + sx, from.y + sy, from.z};
  const auto is_level = [&](const VoxelKey& key, int x, int y) {
    int z = 0;
    return ground.OutcomeOf(key, x, y, &z) == StepOutcome::kGround && z == from.z;
  };
  if (!is_level(from, ax, ay) || !is_level(from, sx, sy) || !is_level(beside, sx, sy) ||
      !is_level(ahead, ax, ay))
    return std::nullopt;
  const Clearance room = std::max({ground.ClearanceOf(beside), ground.ClearanceOf(ahead),
                                   ground.ClearanceOf({from.x + dx, from.y + dy, from.z})});
  return room == Clearance::kPinch ? std::nullopt : std::optional(room);
}

/// Bellman and Ford's relaxation until nothing changes, over a dictionary: slow and simple.
std::map<VoxelKey, double> PlainCosts(const GroundMap& ground, const VoxelKey& start, int side) {
  const PlannerConfig config;
  std::map<VoxelKey, double> costs{{start, 0}};
  for (bool is_changing = true; is_changing;) {
    is_changing = false;
    const auto known = costs;
    for (const auto& [from, cost] : known)
      for (int dx = -2; dx <= 2; ++dx)
        for (int dy = -2; dy <= 2; ++dy) {
          const bool is_near = std::max(std::abs(dx), std::abs(dy)) == 1;
          const auto oblique = ObliqueRoom(ground, from, dx, dy);
          int z = from.z;
          if (!oblique && (!is_near || ground.OutcomeOf(from, dx, dy, &z) != StepOutcome::kGround))
            continue;
          const VoxelKey to{from.x + dx, from.y + dy, z};
          if (to.x < 0 || to.y < 0 || to.x >= side || to.y >= side) continue;
          const Clearance room = oblique.value_or(ground.ClearanceOf(to));
          if (room == Clearance::kPinch && ground.ClearanceOf(from) != Clearance::kPinch) continue;
          const double next = cost + GroundEdgeCost(from, to, room, ground.climb(), config);
          const auto it = costs.find(to);
          if (it != costs.end() && it->second <= next + 1e-9) continue;
          costs[to] = next;
          is_changing = true;
        }
  }
  return costs;
}

TEST(GroundSearch, CostsEqualPlainRelaxationOnRandomGround) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Rng rng(seed);
    constexpr int kSide = 22;
    VoxelMap map;
    // Columns beyond the edge are walls, so that nothing is unseen and no bridge is looked for.
    for (int x = -1; x <= kSide; ++x)
      for (int y = -1; y <= kSide; ++y) {
        const bool is_edge = x < 0 || y < 0 || x == kSide || y == kSide;
        if (is_edge || (rng.Chance(0.12) && (x > 2 || y > 2)))
          AddColumn(map, x, y, 0, 30);
        else
          AddGround(map, x, y, x + 1, y + 1, (x / 7) * 2 + (rng.Chance(0.1) ? 1 : 0));
      }
    const GroundMap ground = GroundOf(map);
    const auto start = ground.StandingNear(1, 1, 1, 3);
    ASSERT_TRUE(start);
    const auto costs = CostsFrom(ground, {1, 1, *start});
    const auto plain = PlainCosts(ground, {1, 1, *start}, kSide);
    ASSERT_EQ(costs.size(), plain.size()) << seed;
    for (const auto& [key, cost] : plain) EXPECT_NEAR(costs.at(key), cost, 1e-9);
  }
}

TEST(GroundSearch, IsNearlyStraightInEachDirection) {
  VoxelMap map;
  AddGround(map, 0, 0, 60, 60, 0);
  const GroundMap ground = GroundOf(map);
  const auto costs = CostsFrom(ground, {30, 30, 1});
  for (const auto& [key, cost] : costs) {
    if (std::max(std::abs(key.x - 30), std::abs(key.y - 30)) > 20) continue;
    EXPECT_LE(cost, 1.028 * geometry::VoxelDistance(key, {30, 30, 1}) + 1e-9);
  }
}

TEST(GroundSearch, ThePathOfAnObliqueStepHasItsPlaceBetween) {
  VoxelMap map;
  AddGround(map, 0, 0, 30, 30, 0);
  const GroundMap ground = GroundOf(map);
  GroundSearch search(ground, PlannerConfig(), {5, 5, 1});
  const VoxelKey to{25, 15, 1};
  while (const auto key = search.Next())
    if (*key == to) break;
  const auto path = search.PathTo(to);
  ASSERT_GT(path.size(), 1u);
  for (std::size_t i = 1; i < path.size(); ++i)
    EXPECT_LT(geometry::VoxelDistance(path[i - 1], path[i]), 1.5);
}

// Searches cache a place until a change near it.
TEST(GroundSearch, AfterEachChangeTheCostsEqualThoseOfFreshGround) {
  Rng rng(11);
  VoxelMap map;
  AddGround(map, 0, 0, 40, 40, 0);
  GroundMap ground = GroundOf(map);
  const VoxelKey start{20, 20, 1};
  std::vector<Vector3d> bumps;
  for (int round = 0; round < 60; ++round) {
    std::vector<geometry::StateChange> changes;
    for (int i = 0; i < 12; ++i) {
      const VoxelKey key{rng.Int(0, 39), rng.Int(0, 39), rng.Int(0, 6)};
      if (std::abs(key.x - start.x) < 2 && std::abs(key.y - start.y) < 2) continue;
      const auto state = rng.Chance(0.4)   ? VoxelState::kOccupied
                         : rng.Chance(0.7) ? VoxelState::kTraversable
                                           : VoxelState::kUnknown;
      SetState(map, key, state);
      changes.push_back({key, {state, false}});
    }
    ground.Update(changes);
    if (round % 7 == 3) {
      bumps.emplace_back(rng.Uniform(0, 4), rng.Uniform(0, 4), 0.1);
      ground.Block(bumps.back());
    }
    if (round % 20 == 19) {
      bumps.clear();
      ground.ForgetBlocked();
    }
    GroundMap fresh = GroundOf(map);
    for (const Vector3d& p : bumps) fresh.Block(p);
    ASSERT_EQ(CostsFrom(ground, start), CostsFrom(fresh, start)) << round;
  }
}

TEST(GroundSearch, APathBeginsAtItsStartAndTakesNeighbouringPlaces) {
  VoxelMap map;
  AddGround(map, 0, 0, 20, 3, 0);
  const GroundMap ground = GroundOf(map);
  const PlannerConfig config;
  GroundSearch search(ground, config, {1, 1, 1});
  while (search.Next()) {
  }
  const auto path = search.PathTo({18, 1, 1});
  ASSERT_EQ(path.size(), 18u);
  EXPECT_EQ(path.front(), (VoxelKey{1, 1, 1}));
  EXPECT_EQ(path.back(), (VoxelKey{18, 1, 1}));
  EXPECT_FALSE(search.CostOf({50, 1, 1}));
}

}  // namespace
}  // namespace crossnav::planner
