// SPDX-License-Identifier: MIT
// Where a goal may stand on surfaces that were set by hand.
#include "crossnav/agent/search_shares.h"

#include <gtest/gtest.h>

#include "crossnav/agent/carriers.h"
#include "crossnav/agent/whereabouts.h"
#include "support/map_of_states.h"

namespace crossnav::agent {
namespace {

using geometry::VoxelKey;

/// Probability that the goal is on the small table of 0.4 x 0.4 m, which stands apart from a table
/// of 1.2 x 1.2 m. `base_m`: side of the goal's record; 0 = no record.
double ShareOfSmallTable(double base_m) {
  const Config config;
  World world(config);
  const auto add_top = [&](int x0, int x1) {
    for (int x = x0; x < x1; ++x)
      for (int y = 0; y < x1 - x0; ++y) {
        test::SetState(world.map, {x, y, 6}, geometry::VoxelState::kOccupied);
        test::SetState(world.map, {x, y, 7}, geometry::VoxelState::kTraversableFake);
      }
  };
  add_top(0, 4);
  add_top(20, 32);
  world.full.field.Update(world.map, 0, 0.88, {0, 0, 0}, {31, 15, 10});
  EXPECT_EQ(world.full.field.patches().size(), 10U);
  if (base_m > 0) {
    objects::ObjectRecord record;
    record.category = "armchair";
    record.views = 3;
    record.box_world_m.extend(Vector3d(9, 9, 0)).extend(Vector3d(9 + base_m, 9 + base_m, 1));
    world.objects.Load({record});
  }
  GoalState goal;
  goal.goal = "armchair";
  goal.full.search.emplace();
  double small = 0, all = 0;
  for (const auto& [cell, share] : SharesOf(world, goal, {})) {
    small += cell.x == 0 ? share : 0;
    all += share;
  }
  EXPECT_NEAR(all, 1, 1e-9);
  return small;
}

// Regression: surfaces between other things, too small for a television, counted as left to search.
TEST(SearchShares, AThingIsHardlyWhereItDoesNotFit) {
  EXPECT_NEAR(ShareOfSmallTable(0), 0.1, 1e-9) << "of what has no record, the area alone is known";
  EXPECT_LT(ShareOfSmallTable(0.7), 0.02);
  EXPECT_GT(ShareOfSmallTable(0.2), 0.08);
}

constexpr int kTop_z = 6;

/// A floor of 4 x 4 m at `z`, with a bed (x from 0.4 m) and a table (x from 2.4 m) of a size if it
/// is furnished.
void AddFloor(World& world, int z, bool is_furnished) {
  test::AddGround(world.map, 0, 0, 40, 40, z);
  if (!is_furnished) return;
  for (const int x0 : {4, 24})
    for (int x = x0; x < x0 + 12; ++x)
      for (int y = 8; y < 20; ++y)
        for (int dz = 1; dz <= kTop_z; ++dz)
          test::SetState(world.map, {x, y, z + dz}, geometry::VoxelState::kOccupied);
}

objects::ObjectRecord RecordOf(const std::string& category, const Vector3d& min,
                               const Vector3d& max) {
  objects::ObjectRecord record;
  record.category = category;
  record.views = 3;
  record.confidence = 0.9;
  record.centre_world_m = 0.5 * (min + max);
  record.box_world_m.extend(min).extend(max);
  return record;
}

objects::ObjectRecord Bed() {
  objects::ObjectRecord bed = RecordOf("bed", {0.4, 0.8, 0.1}, {1.6, 2.0, 0.7});
  for (int x = 4; x < 16; ++x)
    for (int y = 8; y < 20; ++y) bed.voxels.push_back({x, y, kTop_z});
  return bed;
}

objects::ObjectRecord Vase(double x_m, double y_m) {
  return RecordOf("vase", {x_m, y_m, 0.7}, {x_m + 0.1, y_m + 0.1, 1.0});
}

/// The share of the bed in both tops; `vases` stand on the table.
double ShareOfBed(int vases) {
  World world{Config()};
  AddFloor(world, 0, true);
  world.revision = RevisionOf(world);
  world.full.field.Update(world.map, 0.1, 0.88, {0, 0, 0}, {39, 39, 0});
  std::vector<objects::ObjectRecord> records = {Bed()};
  for (int i = 0; i < vases; ++i) records.push_back(Vase(2.5 + 0.3 * (i / 4), 0.9 + 0.3 * (i % 4)));
  world.objects.Load(std::move(records));
  GoalState goal;
  goal.goal = "book";
  goal.full.search.emplace();
  double bed = 0, tops = 0;
  for (const auto& [cell, share] : SharesOf(world, goal, OddsOf(world, goal))) {
    const auto& patch = world.full.field.patches().at(cell);
    if (patch.height_m <= kFurnitureTop_m) continue;
    tops += share;
    bed += patch.p_world.x() < 2 ? share : 0;
  }
  return bed / tops;
}

TEST(SearchShares, WhereNothingStandsOnBedsABedIsAnUnlikelyPlace) {
  EXPECT_NEAR(ShareOfBed(0), 0.5, 0.01) << "nothing is known";
  EXPECT_NEAR(ShareOfBed(4), 0.25, 0.02) << "half is believed";
  EXPECT_LT(ShareOfBed(12), 0.14);
}

TEST(SearchShares, AThingOfTopsIsOnTheFloorWithTables) {
  World world{Config()};
  AddFloor(world, 0, true);
  AddFloor(world, 28, false);
  world.revision = RevisionOf(world);
  ASSERT_EQ(world.revision->graph.floors.size(), 2U);
  for (const double level_m : {0.1, 2.9})
    world.full.field.Update(world.map, level_m, 0.88, {0, 0, 0}, {39, 39, 0});
  world.objects.Load({Vase(2.5, 1.0)});
  GoalState goal;
  goal.full.search.emplace();
  const auto odds_below = [&](const std::string& name) {
    goal.goal = name;
    double below = 0;
    for (const auto& [room, odds] : OddsOf(world, goal))
      if (world.revision->graph.rooms[static_cast<std::size_t>(room)].floor == 0) below += odds;
    return below;
  };
  EXPECT_GT(odds_below("vase"), 0.65);
  EXPECT_LT(odds_below("chair"), 0.6);
}

// Regression: on the second day in a house of which the first had seen one floor, what stood on
// another floor had no probability, and the search ended without it.
TEST(SearchShares, AFloorThatTodayShowsHasRooms) {
  World world{Config()};
  AddFloor(world, 0, true);
  world.revision = RevisionOf(world);
  EXPECT_FALSE(UpdateRooms(&world)) << "nothing new";
  AddFloor(world, 28, false);
  EXPECT_TRUE(UpdateRooms(&world));
  EXPECT_EQ(world.revision->graph.floors.size(), 2U);
  EXPECT_EQ(world.revision->loaded.floors.size(), 1U);
  EXPECT_FALSE(UpdateRooms(&world));
}

}  // namespace
}  // namespace crossnav::agent
