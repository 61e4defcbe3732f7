// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {
namespace {

/// A floor at height `z_m`, looked at from above with depth noise of a few float roundings.
DepthImage FloorFromAbove(int side, double height_m) {
  DepthImage depth(side, side);
  for (int i = 0; i < side * side; ++i)
    depth.data[i] = static_cast<float>(height_m + 1e-7 * (i % 5 - 2));
  return depth;
}

Pose LookingDown(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T.translation() = Vector3d(x, y, z);
  return T;
}

class FootHeightTest : public ::testing::TestWithParam<double> {};

TEST_P(FootHeightTest, TheAgentStandsOnTraversableAirAtEveryFloorHeight) {
  const double floor_m = GetParam();
  VoxelMap map;
  const Vector3d foot(0.55, 0.55, floor_m);
  map.ObserveBody(foot, 0.88);
  map.UpdateStates();
  const int z_foot = static_cast<int>(std::floor((floor_m + 0.1) / 0.1 + 1e-6));
  EXPECT_EQ(map.StateAt({5, 5, z_foot}), VoxelState::kTraversable);

  const CameraIntrinsics camera = IntrinsicsFromHfov(160, 160, 1.2);
  map.Integrate(FloorFromAbove(160, 0.88), camera, LookingDown(0.55, 0.55, floor_m + 0.88));
  map.ObserveBody(foot, 0.88);
  map.UpdateStates();
  for (int x = 2; x <= 8; ++x) {
    EXPECT_EQ(map.StateAt({x, 5, z_foot}), VoxelState::kTraversable) << x;
    EXPECT_FALSE(map.At({x, 5, z_foot}).is_inflated) << x;
    VoxelKey support;
    ASSERT_TRUE(map.FindSupport({x, 5, z_foot}, &support)) << x;
    EXPECT_GE(support.z, z_foot - 2) << x;
  }
}

TEST_P(FootHeightTest, StandingOnAFloorDoesNotEraseIt) {
  const double floor_m = GetParam();
  VoxelMap map;
  const CameraIntrinsics camera = IntrinsicsFromHfov(160, 160, 1.2);
  map.Integrate(FloorFromAbove(160, 0.88), camera, LookingDown(0.55, 0.55, floor_m + 0.88));
  map.UpdateStates();
  std::map<VoxelKey, Voxel> before = StatesOf(map);
  map.ObserveBody({0.55, 0.55, floor_m}, 0.88);
  map.UpdateStates();
  for (const auto& [key, voxel] : before) {
    if (IsSurface(voxel.state)) {
      EXPECT_TRUE(IsSurface(map.StateAt(key)));
    }
  }
  const auto after = StatesOf(map);
  for (const auto& [key, voxel] : after)
    EXPECT_EQ(IsSurface(voxel.state), before.count(key) && IsSurface(before[key].state));
}

INSTANTIATE_TEST_SUITE_P(Heights, FootHeightTest,
                         ::testing::Values(0.0, 0.1, 0.03, 0.099, 2.7, 2.75, -0.3, -2.95, 1e-9,
                                           -1e-9));

}  // namespace
}  // namespace crossnav::geometry::testing
