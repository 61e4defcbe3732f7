// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/held_out.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace crossnav::evaluation {
namespace {

/// A camera that looks along +x at a wall `depth_m` ahead.
Observation LookAtWall(double depth_m) {
  Observation obs;
  obs.camera = {64, 64, 60, 60, 31.5, 31.5};
  obs.depth_m = DepthImage(64, 64, static_cast<float>(depth_m));
  Eigen::Matrix3d R;
  R.col(0) = -Vector3d::UnitY();
  R.col(1) = -Vector3d::UnitZ();
  R.col(2) = Vector3d::UnitX();
  obs.T_world_camera = Pose::Identity();
  obs.T_world_camera.linear() = R;
  return obs;
}

geometry::VoxelMap MapOfWall(double depth_m) {
  geometry::VoxelMap map{geometry::MapConfig{}};
  const Observation obs = LookAtWall(depth_m);
  map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  map.UpdateStates();
  return map;
}

TEST(HeldOut, AnotherFrameOfTheSameWallIsPredictedToHalfAVoxel) {
  HeldOutResult result;
  AddHeldOut(MapOfWall(3.04), LookAtWall(3.04), &result);
  EXPECT_EQ(result.rays, 16 * 16);
  EXPECT_EQ(result.known, result.rays);
  EXPECT_EQ(result.violations, 0);
  ASSERT_GT(result.errors_m.size(), 200U);
  EXPECT_LE(*std::max_element(result.errors_m.begin(), result.errors_m.end()), 0.1);
}

TEST(HeldOut, AWallThatNoiseMadeThickIsPredictedInItsMiddle) {
  geometry::VoxelMap map{geometry::MapConfig{}};
  for (const double depth_m : {2.95, 3.05, 3.15}) {  // a voxel nearer, and a voxel farther
    const Observation obs = LookAtWall(depth_m);
    map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  }
  map.UpdateStates();
  HeldOutResult result;
  AddHeldOut(map, LookAtWall(3.05), &result);
  ASSERT_GT(result.errors_m.size(), 200U);
  std::nth_element(result.errors_m.begin(), result.errors_m.begin() + 100, result.errors_m.end());
  EXPECT_LE(result.errors_m[100], 0.02);
}

TEST(HeldOut, ASlantedWallIsPredictedToATenthOfAVoxel) {
  Observation obs = LookAtWall(0);
  for (int v = 0; v < obs.depth_m.height; ++v)
    for (int u = 0; u < obs.depth_m.width; ++u) {
      const Vector3d ray = BackProjectPixel(obs.camera, u, v, 1.0);
      obs.depth_m.At(u, v) = static_cast<float>(2.0 / (1.0 - 0.5 * ray.x()));  // z = 2 + x / 2
    }
  geometry::VoxelMap map{geometry::MapConfig{}};
  map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  map.UpdateStates();
  HeldOutResult result;
  AddHeldOut(map, obs, &result);
  std::nth_element(result.errors_m.begin(), result.errors_m.begin() + 100, result.errors_m.end());
  EXPECT_LE(result.errors_m[100], 0.02);
}

TEST(HeldOut, ARayThatEndsInTheMiddleOfFreeSpaceViolatesIt) {
  HeldOutResult result;
  AddHeldOut(MapOfWall(3.04), LookAtWall(1.5), &result);
  EXPECT_EQ(result.violations, result.rays);
  EXPECT_NEAR(result.errors_m.front(), 1.54, 0.1);
}

TEST(HeldOut, UnknownSpaceIsNoViolation) {
  HeldOutResult result;
  AddHeldOut(MapOfWall(3.04), LookAtWall(4.0), &result);
  EXPECT_EQ(result.violations, 0);
  EXPECT_LT(result.known, result.rays / 10);
  HeldOutResult empty;
  AddHeldOut(geometry::VoxelMap{geometry::MapConfig{}}, LookAtWall(3), &empty);
  EXPECT_EQ(empty.known, 0);
  EXPECT_TRUE(empty.errors_m.empty());
  HeldOutResult blind;
  AddHeldOut(MapOfWall(3.04), LookAtWall(0), &blind);
  EXPECT_EQ(blind.rays, 0);
}

}  // namespace
}  // namespace crossnav::evaluation
