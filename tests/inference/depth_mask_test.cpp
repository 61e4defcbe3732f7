// SPDX-License-Identifier: MIT
#include "crossnav/inference/depth_mask.h"

#include <gtest/gtest.h>

namespace crossnav::inference::test {
namespace {

perception::Detection Boxed(int u0, int v0, int u1, int v1) {
  return {{u0, v0, u1, v1}, 0.9F, {}, 0};
}

TEST(DepthMask, TakesTheObjectAndLeavesTheWallBehindIt) {
  DepthImage depth(64, 64, 3.0F);
  for (int v = 20; v < 40; ++v)
    for (int u = 20; u < 40; ++u) depth.At(u, v) = 1.5F;
  const auto found = DepthMask(depth, Boxed(15, 15, 45, 45));
  EXPECT_EQ(found.mask.At(20, 20), 1);
  EXPECT_EQ(found.mask.At(39, 39), 1);
  EXPECT_EQ(found.mask.At(17, 17), 0);
  EXPECT_EQ(found.mask.At(50, 50), 0);
  EXPECT_GT(found.mask_quality, 0.9F);
}

TEST(DepthMask, ABarInFrontIsNotTheObject) {
  DepthImage depth(64, 64, 3.0F);
  for (int v = 0; v < 64; ++v) depth.At(32, v) = depth.At(33, v) = 0.5F;
  const auto found = DepthMask(depth, Boxed(16, 16, 48, 48));
  EXPECT_EQ(found.mask.At(32, 30), 0);
  EXPECT_EQ(found.mask.At(24, 30), 1);
}

TEST(DepthMask, WithoutDepthThereIsNoMask) {
  const auto found = DepthMask(DepthImage(16, 16), Boxed(-4, 2, 40, 12));
  EXPECT_EQ(found.mask_quality, 0);
  EXPECT_EQ(found.mask.width, 16);
}

}  // namespace
}  // namespace crossnav::inference::test
