// SPDX-License-Identifier: MIT
// Rays in a furnished house, where surfaces lie in one plane, objects touch, and rays along the
// axes of the world meet edges.
#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/house/embedded_house.h"
#include "support/temp_folder.h"

namespace crossnav::world {
namespace {

/// Most rays on a grid along the axes, as the changes of a night cast them; some in any direction.
std::optional<sim::RayHit> CastOne(const sim::RayCaster& caster, const Box3& house, Rng& rng) {
  const auto on_grid = [&](int axis) {
    return std::round(rng.Uniform(house.min[axis], house.max[axis]) / 0.15) * 0.15;
  };
  const Vector3d from{on_grid(0), on_grid(1), on_grid(2) + 0.1 * rng.Int(0, 2)};
  Vector3d direction = Vector3d::Zero();
  const int axis = rng.Int(0, 3);
  if (axis < 3) direction[axis] = rng.Chance(0.5) ? 1 : -1;
  if (axis == 3) direction = Vector3d{rng.Normal(), rng.Normal(), rng.Normal()};
  return caster.Cast(from, direction, 0.1 * rng.Int(1, 60));
}

TEST(HouseRays, MeetTheSameWithEstimatesOfOtherProcessors) {
  const test::TempFolder dir;
  const auto folder = WriteEmbeddedHouse(dir.path());
  ASSERT_TRUE(folder.has_value()) << folder.error().Message();
  const auto scene = sim::LoadScene(*folder);
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  Box3 house;
  for (const Vector3f& p : scene->mesh.vertices) house.Add(p.cast<double>());
  // AVX estimates reciprocals in another way, as processors of other makers do with AVX2.
  const sim::RayCaster caster(*scene), other(*scene, "avx");
  constexpr int kRays = 100000;
  int met = 0;
  Rng rng(1), same(1);
  for (int i = 0; i < kRays; ++i) {
    const auto a = CastOne(caster, house, rng), b = CastOne(other, house, same);
    ASSERT_EQ(a.has_value(), b.has_value()) << "ray " << i;
    if (!a) continue;
    ++met;
    ASSERT_EQ(a->triangle, b->triangle) << "ray " << i;
    ASSERT_EQ(a->distance_m, b->distance_m) << "ray " << i;
    ASSERT_EQ(a->colour, b->colour) << "ray " << i;
  }
  EXPECT_GT(met, kRays / 2);
}

}  // namespace
}  // namespace crossnav::world
