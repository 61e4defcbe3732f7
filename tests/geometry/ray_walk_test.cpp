// SPDX-License-Identifier: MIT
#include "crossnav/geometry/ray_walk.h"

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "tests/geometry/reference_map.h"

namespace crossnav::geometry::testing {
namespace {

KeySet Walked(const Vector3d& a, const Vector3d& b) {
  KeySet keys;
  WalkRay(a, b, [&](const VoxelKey& key) { return keys.insert(key).second; });
  return keys;
}

/// Random ends, many of them on faces, edges and corners of voxels.
Vector3d RandomEnd(Rng& rng) {
  Vector3d p;
  for (int a = 0; a < 3; ++a)
    p[a] = rng.Chance(0.4)   ? rng.Int(-6, 6)
           : rng.Chance(0.2) ? rng.Int(-12, 12) * 0.5
                             : rng.Uniform(-6, 6);
  return p;
}

TEST(RayWalkTest, VisitsTheVoxelsOfTheLiteralWalk) {
  Rng rng(1);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d a = RandomEnd(rng), b = RandomEnd(rng);
    KeySet literal;
    WalkPixel(a.data(), b.data(), [&](const VoxelKey& key) { literal.insert(key); });
    EXPECT_TRUE(Walked(a, b) == literal);
  }
}

TEST(RayWalkTest, RayPassesSaysForEveryVoxelWhetherTheWalkVisitsIt) {
  Rng rng(2);
  for (int i = 0; i < 400; ++i) {
    const Vector3d a = RandomEnd(rng), b = RandomEnd(rng);
    const KeySet walked = Walked(a, b);
    for (int x = -8; x <= 8; ++x)
      for (int y = -8; y <= 8; ++y)
        for (int z = -8; z <= 8; ++z)
          ASSERT_EQ(RayPasses(a, b, {x, y, z}), walked.count({x, y, z}) == 1);
  }
}

TEST(RayWalkTest, StopsWhenToldTo) {
  int count = 0;
  WalkRay({0.5, 0.5, 0.5}, {9.5, 0.5, 0.5}, [&](const VoxelKey&) { return ++count < 3; });
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace crossnav::geometry::testing
