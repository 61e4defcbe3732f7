// SPDX-License-Identifier: MIT
// Views of a search in a small room that was set by hand.
#include "crossnav/agent/search_views.h"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "crossnav/agent/object_search.h"
#include "crossnav/agent/whereabouts.h"
#include "support/map_of_states.h"

namespace crossnav::agent {
namespace {

using geometry::VoxelKey;
using geometry::VoxelState;

constexpr VoxelKey kStart{4, 10, 1};

/// A top `height_vox` above the ground, 1.3 m from the agent, holds the goal with `share`.
struct RoomWithTop {
  Config config;
  World world{config};
  GoalState goal;
  AgentPose agent;
  Observation obs;
  std::vector<policy::Sighting> sightings;

  explicit RoomWithTop(int height_vox, double share = 1) {
    test::AddGround(world.map, 0, 0, 20, 20, 0);
    VoxelKey hi;
    for (int x = 16; x < 20; ++x)
      for (int y = 8; y < 12; ++y)
        for (int z = 1; z <= height_vox; ++z)
          test::SetState(world.map, hi = {x, y, z}, VoxelState::kOccupied);
    world.ground.Rebuild(world.map);
    world.level_m = 0.1;
    world.full.field.Update(world.map, world.level_m, 0.88, {16, 8, 0}, hi);
    ObjectSearch& search = goal.full.search.emplace();
    search.notice_range_m = search.sure_range_m = 5;
    search.is_tall = true;
    for (const auto& [cell, patch] : world.full.field.patches())
      if (patch.height_m > 0.25) search.shares[cell] = share;
    EXPECT_EQ(search.shares.size(), 1U);
    agent.p_world = Vector3d(0.45, 1.05, 0.1);
    obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  }
  Situation Now() const { return {config, world, goal, agent, agent, obs, sightings}; }
};

std::optional<SearchView> ViewOfTop(int height_vox) {
  const RoomWithTop room(height_vox);
  const Situation now = room.Now();
  return SearchViews(now).From(kStart, 0, 0);
}

/// Regression: a television on a board of 1.1 m was out of every lowered picture of its room.
TEST(SearchViews, ATopAboveTheCameraIsLookedAtLevel) {
  const auto high = ViewOfTop(11), low = ViewOfTop(4);
  ASSERT_TRUE(high.has_value());
  EXPECT_DOUBLE_EQ(high->pitch_rad, 0);
  ASSERT_TRUE(low.has_value());
  EXPECT_DOUBLE_EQ(low->pitch_rad, DegToRad(Config{}.policy.motion.travel_pitch_deg));
  EXPECT_LT(low->cost_m, high->cost_m);
}

/// Regression: a television was given up 60 actions after its record was gone, in a room that
/// nobody had looked into, because the way there was long for its probability.
TEST(SearchViews, WhatCostsMuchForItsChanceIsLeftOutOnlyWhereLittleIsUnseen) {
  RoomWithTop room(4, 0.006);
  room.goal.full.search->notice_range_m = 0.9;  // nothing shows it from where the agent is
  for (int i = -1; i <= 20; ++i)
    for (int z = 0; z <= 14; ++z)
      for (const VoxelKey wall : {VoxelKey{i, -1, z}, {i, 20, z}, {-1, i, z}, {20, i, z}})
        test::SetState(room.world.map, wall, VoxelState::kOccupied);
  room.world.ground.Rebuild(room.world.map);
  room.world.revision.emplace();
  double& unseen = room.goal.full.search->unseen;
  unseen = 0.15;  // and a third of the chance that it is there at all
  EXPECT_FALSE(PriceSearch(room.Now(), kStart).empty());
  unseen = 0.1;
  EXPECT_TRUE(PriceSearch(room.Now(), kStart).empty());
  // The less is left, the more the same share is of it.
  unseen = 0.01;
  EXPECT_FALSE(PriceSearch(room.Now(), kStart).empty());
}

/// Regression: from a landing the floor above counted as tops of furniture, and high tops below as
/// ground; a search went to and fro between both floors until the budget was spent.
TEST(SearchViews, ALandingOfAKnownHouseHasNoPatchesOfItsOwn) {
  const auto height_from_m = [](const std::vector<double>& floors_m, double level_m) {
    RoomWithTop room(13);
    room.world.revision.emplace();
    for (const double height_m : floors_m) {
      auto& floor = room.world.revision->graph.floors.emplace_back();
      floor.height_m = height_m;
    }
    room.world.has_level = true;
    room.world.level_m = level_m;
    room.agent.p_world.z() = level_m;
    room.world.step = room.goal.full.search->step = 6;
    StepState now{room.config, room.world, room.goal,     room.agent,
                  room.agent,  room.obs,   room.sightings};
    UpdateSearch(now);
    return room.world.full.field.patches()
        .at(room.goal.full.search->shares.begin()->first)
        .height_m;
  };
  EXPECT_NEAR(height_from_m({0.1, 2.9}, 1.5), 1.3, 0.1);
  EXPECT_NEAR(height_from_m({0.1, 1.5}, 1.5), -0.1, 0.1);  // a floor
}

/// Regression: a thin floor lamp that no day had met counted as seen from 4 m.
TEST(SearchViews, AThingThatWasNeverMetIsMissedFromAfarMoreOften) {
  const Config config;
  World world(config);
  GoalState goal;
  goal.goal = "floor lamp";
  const NoticeRanges unknown = RangesOfNotice(world, goal, config);
  objects::ObjectRecord lamp;
  lamp.category = goal.goal;
  lamp.views = 5;
  lamp.box_world_m.extend(Vector3d(0, 0, 0)).extend(Vector3d(0.5, 0.5, 1.7));
  world.objects.Load({lamp});
  const NoticeRanges known = RangesOfNotice(world, goal, config);
  EXPECT_LT(unknown.surely_m, known.surely_m);
  EXPECT_GT(unknown.missed, 2 * known.missed);
}

}  // namespace
}  // namespace crossnav::agent
