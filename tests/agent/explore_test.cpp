// SPDX-License-Identifier: MIT
// Which of the places to look next comes first, on ground that was set by hand.
#include "crossnav/agent/explore.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/map_of_states.h"

namespace crossnav::agent {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;
using test::AddGround;
using test::SetState;

constexpr int kSide = 30;      // columns of the room
constexpr int kHead_vox = 20;  // walls
const VoxelKey kStart{15, 15, 1};

void Wall(VoxelMap& map, int x, int y) {
  for (int z = -40; z <= kHead_vox; ++z) SetState(map, {x, y, z}, VoxelState::kOccupied);
}

/// A room with walls; the columns [12, 18) of the sides x = 30 and x = -1 are open.
VoxelMap Room() {
  VoxelMap map;
  AddGround(map, 0, 0, kSide, kSide, 0);
  for (int i = -1; i <= kSide; ++i) {
    const bool is_open = i >= 12 && i < 18;
    for (const int edge : {-1, kSide}) {
      Wall(map, i, edge);
      if (!is_open) Wall(map, edge, i);
    }
  }
  return map;
}

/// Treads of two columns from x = 30 on, `rise_vox` each, between walls.
void AddTreads(VoxelMap& map, int count, int rise_vox) {
  for (int tread = 0; tread < count; ++tread) {
    const int x = kSide + 2 * tread;
    AddGround(map, x, 12, x + 2, 18, (tread + 1) * rise_vox);
    for (const int y : {11, 18})
      for (const int dx : {0, 1}) Wall(map, x + dx, y);
  }
}

struct Chosen {
  GroundTarget target;
  bool is_flight = false;
};

/// Choice of an agent at `start` that looks west, pursues `committed`, saw `hints` and stood on
/// `other_levels_m`. Stairs were seen there.
Chosen Choose(const VoxelMap& map, const std::string& goal_name, const VoxelKey& start = kStart,
              const policy::Candidate* committed = nullptr,
              const std::vector<policy::Sighting>& hints = {},
              const std::vector<double>& other_levels_m = {}) {
  Config config;
  config.policy.explore.uninspected_m = 1000;  // all of it was seen from near
  World world(config);
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel& voxel) {
    SetState(world.map, key, voxel.state);
  });
  world.ground.Rebuild(world.map);
  std::vector<geometry::SeenStair> stairs;
  for (const double level_m : other_levels_m)
    for (int y = 12; y < 18; ++y)
      for (int dz = -1; dz <= 1; ++dz)
        for (int dx = 4; dx < 6; ++dx)
          stairs.push_back(
              {{kSide + dx, y, static_cast<int>(std::lround(level_m / config.map.voxel_m)) + dz},
               1,
               1,
               true});
  world.stairs.Import(stairs);
  world.has_level = true;
  world.levels_m = {0.1};
  world.levels_m.insert(world.levels_m.end(), other_levels_m.begin(), other_levels_m.end());
  world.level_m = 0.1;
  GoalState goal;
  goal.goal = goal_name;
  if (committed) {
    Climb climb;
    climb.target = *committed;
    goal.full.activity = Pursuit(std::move(climb));
  }
  policy::ObjectConfig any;
  any.detector_confidence = any.min_box_area_fraction = 0;
  goal.full.hints.Update(hints, any, config.map.voxel_m, 0);
  AgentPose agent;
  agent.yaw_rad = M_PI;
  agent.p_world = CenterOf(start, config.map.voxel_m) - Vector3d(0, 0, 0.05);
  const Observation obs;
  const std::vector<policy::Sighting> sightings;
  const Situation now{config, world, goal, agent, agent, obs, sightings};
  auto target = ChooseExploration(now, start).target;
  if (!target) {
    ADD_FAILURE() << "nothing to look at";
    return {};
  }
  const bool is_flight = target->candidate.p_focus_world.x() > 0.1 * kSide;
  return {std::move(*target), is_flight};
}

/// Of something as large as a stool that stands at column `x`, `y` on ground at `z`.
policy::Sighting HintAt(int x, int y, int z = 0) {
  policy::Sighting hint;
  for (int i = 0; i < 27; ++i) hint.voxels.push_back({x + i / 9, y + i / 3 % 3, z + 1 + i % 3});
  hint.p_center_world = geometry::CenterOf({x + 1, y + 1, z + 2}, 0.1);
  hint.confidence = 0.5;
  return hint;
}

// A door on one side, a flight up on the other, as far away: where the goal is likelier decides.
TEST(Explore, AFlightUpComesFirstForABedAndLastForASofa) {
  VoxelMap map = Room();
  AddTreads(map, 6, 2);
  EXPECT_TRUE(Choose(map, "bed").is_flight);
  EXPECT_FALSE(Choose(map, "sofa").is_flight);
  EXPECT_FALSE(Choose(map, "chair").is_flight);
}

TEST(Explore, AFlightDownComesFirstForASofaAndLastForABed) {
  VoxelMap map = Room();
  AddTreads(map, 2, -2);
  EXPECT_TRUE(Choose(map, "sofa").is_flight);
  EXPECT_FALSE(Choose(map, "bed").is_flight);
  EXPECT_FALSE(Choose(map, "chair").is_flight);
}

// Regression: from a landing the floor below, where stairs were claimed by mistake, was a flight to
// where a sofa is likelier; from that floor a hint above was nearer. The agent went to and fro.
TEST(Explore, AFloorThatWasStoodOnIsNoLikelierFloor) {
  VoxelMap map = Room();
  AddTreads(map, 3, -2);
  EXPECT_TRUE(Choose(map, "sofa").is_flight);
  EXPECT_FALSE(Choose(map, "sofa", kStart, nullptr, {}, {-0.5}).is_flight);
}

// Regression: the price of the flight is negative there, and the refund of its class cancelled it:
// at every second look the door was nearer than the rest of the path.
TEST(Explore, APathToALikelierFloorIsContinued) {
  VoxelMap map = Room();
  AddTreads(map, 6, 2);
  const VoxelKey at_door{3, 15, 1};
  const Chosen first = Choose(map, "bed", at_door);
  ASSERT_TRUE(first.is_flight);
  EXPECT_TRUE(Choose(map, "bed", at_door, &first.target.candidate).is_flight);
}

TEST(Explore, AHintIsGoneToPastANearerDoor) {
  const VoxelMap map = Room();
  const Chosen choice = Choose(map, "chair", {5, 15, 1}, nullptr, {HintAt(24, 4)});
  EXPECT_EQ(choice.target.candidate.kind, policy::CandidateKind::kSighting);
}

// The nearest place within reach of it was this side of the wall: nothing was seen from there, and
// the hint was settled.
// Regression: weak sightings drew the agent back to a floor that it had left, past open doors.
TEST(Explore, AHintOnAnotherFloorIsGoneToAfterANearDoor) {
  VoxelMap map = Room();
  AddTreads(map, 10, 2);
  AddGround(map, kSide + 20, 12, kSide + 40, 18, 20);
  const std::vector<policy::Sighting> above = {HintAt(kSide + 30, 14, 20)};
  const Chosen choice = Choose(map, "chair", {3, 15, 1}, nullptr, above);
  EXPECT_FALSE(choice.is_flight) << choice.target.candidate.p_focus_world.transpose();
}

TEST(Explore, AHintBehindAWallIsGoneToThroughTheDoorThatLeadsThere) {
  const VoxelMap map = Room();
  for (const int x : {kSide + 3, -6}) {
    const Chosen choice = Choose(map, "chair", kStart, nullptr, {HintAt(x, 0)});
    EXPECT_EQ(choice.target.candidate.kind, policy::CandidateKind::kTraversableFrontier);
    EXPECT_EQ(choice.target.candidate.p_focus_world.x() > 1.5, x > 0);
  }
}

// The top of a slope to nowhere, 1.2 m up, was taken for a flight of stairs.
TEST(Explore, RisingGroundWithoutStepsIsNoStair) {
  const Config config;
  World world(config);
  world.has_level = true;
  GoalState goal;
  const Observation obs;
  const std::vector<policy::Sighting> sightings;
  const Situation now{config, world, goal, {}, {}, obs, sightings};
  const Vector3d p_top(2.05, 0.05, 1.25);
  EXPECT_FALSE(IsOverStairs(now, {2.05, 0.05, 0.05})) << "the floor";
  EXPECT_FALSE(IsOverStairs(now, p_top));
  EXPECT_TRUE(IsOverStairs(now, {2.05, 0.05, -2.75})) << "a storey away";
  world.stairs.Import({{geometry::KeyOf(p_top - Vector3d(0, 0, 0.1), config.map.voxel_m), 1, 1}});
  EXPECT_TRUE(IsOverStairs(now, p_top)) << "stairs were seen there";
}

// Regression: two treads that border on a few unseen columns had a tenth of their weight, like
// ground behind a bed, and the flight came after everything else on two floors.
TEST(Explore, TheFirstTreadsDownLeadToAnotherFloor) {
  VoxelMap map = Room();
  AddTreads(map, 2, -2);
  for (int y = 11; y <= 18; ++y) Wall(map, kSide + 6, y);  // little unseen ground beyond
  for (int y = 12; y < 18; ++y) Wall(map, -1, y);          // no door
  const Chosen choice = Choose(map, "chair");
  EXPECT_TRUE(choice.is_flight);
  EXPECT_LT(choice.target.score_m, choice.target.cost_m + 15);
}

// The next tread is always the nearest: the agent went from the third floor to the ground past two
// floors that it had not looked at.
TEST(Explore, AnIntermediateFloorIsExploredBeforeTheNextFlight) {
  VoxelMap map = Room();
  AddTreads(map, 10, -3);
  for (int y = 12; y < 18; ++y) Wall(map, -1, y);  // no door
  constexpr int kFloor = -30, kWest = kSide + 20, kEast = kWest + 36;
  AddGround(map, kWest, 12, kEast, 18, kFloor);
  AddGround(map, kWest, 18, kWest + 4, 20, kFloor - 3);  // continues here
  for (int z = kFloor - 6; z <= kFloor + 16; ++z) {
    for (int x = kWest; x < kEast; ++x) {
      SetState(map, {x, 11, z}, VoxelState::kOccupied);
      if (x >= kWest + 4) SetState(map, {x, 18, z}, VoxelState::kOccupied);
    }
    for (const int y : {18, 19}) {
      SetState(map, {kWest - 1, y, z}, VoxelState::kOccupied);
      SetState(map, {kWest + 4, y, z}, VoxelState::kOccupied);
    }
  }
  const Chosen choice = Choose(map, "chair", {kWest + 3, 15, kFloor + 1});
  EXPECT_NEAR(choice.target.candidate.p_focus_world.x(), 0.1 * kEast, 0.2)
      << choice.target.candidate.p_focus_world.transpose();
}

}  // namespace
}  // namespace crossnav::agent
