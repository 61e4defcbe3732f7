// SPDX-License-Identifier: MIT
// Where a goal may stand on surfaces that were set by hand.
#include "crossnav/agent/search_shares.h"

#include <gtest/gtest.h>

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
  world.full.field.Update(world.map, 0, {0, 0, 0}, {31, 15, 10});
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

}  // namespace
}  // namespace crossnav::agent
