// SPDX-License-Identifier: MIT
#include "crossnav/policy/goal_length.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crossnav::policy {
namespace {

using Voxels = std::vector<geometry::VoxelKey>;

constexpr double kGrid_m = 0.1;

/// A seat of the length, 0.9 m deep, turned about the upright axis.
Voxels SeatOf(double length_m, double yaw_rad) {
  Voxels voxels;
  for (double along_m = 0; along_m < length_m; along_m += 0.02)
    for (double across_m = 0; across_m < 0.9; across_m += 0.02)
      voxels.push_back(geometry::KeyOf(
          Vector3d(std::cos(yaw_rad) * along_m - std::sin(yaw_rad) * across_m,
                   std::sin(yaw_rad) * along_m + std::cos(yaw_rad) * across_m, 0.45),
          kGrid_m));
  return voxels;
}

TEST(GoalLength, IsTheLongerSideOfTheSmallestBox) {
  EXPECT_EQ(LengthOf({}, kGrid_m), 0);
  EXPECT_NEAR(LengthOf({{0, 0, 0}, {0, 0, 9}}, kGrid_m), 0.1, 1e-9) << "height does not count";
  for (double yaw_rad = 0; yaw_rad < M_PI; yaw_rad += 0.3)
    EXPECT_NEAR(LengthOf(SeatOf(2.0, yaw_rad), kGrid_m), 2.1, 0.15) << yaw_rad;
}

TEST(GoalLength, ArmchairsAreTooShortForSofasAndForNothingElse) {
  for (double yaw_rad = 0; yaw_rad < M_PI; yaw_rad += 0.3) {
    EXPECT_EQ(ShortnessOf("sofa", LengthOf(SeatOf(0.9, yaw_rad), kGrid_m)), 1) << yaw_rad;
    EXPECT_EQ(ShortnessOf("sofa", LengthOf(SeatOf(1.45, yaw_rad), kGrid_m)), 0) << yaw_rad;
  }
  EXPECT_EQ(ShortnessOf("chair", LengthOf(SeatOf(0.8, 0), kGrid_m)), 0);
  EXPECT_EQ(ShortnessOf("bed", LengthOf(SeatOf(0.8, 0), kGrid_m)), 0);
}

}  // namespace
}  // namespace crossnav::policy
