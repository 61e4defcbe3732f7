// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/ray_caster.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "crossnav/core/rng.h"
#include "micro_scene.h"
#include "ray_oracle.h"

namespace crossnav::sim::test {
namespace {

struct Ray {
  Vector3d origin, direction;
};

Ray RandomRay(Rng& rng) {
  const Vector3d o(rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(0.1, 2.5));
  const Vector3d d(rng.Normal(), rng.Normal(), rng.Normal());
  return {o, d};
}

TEST(RayCaster, SingleRaysAgreeWithBruteForce) {
  const Scene scene = RandomTriangles(12);
  const RayCaster caster(scene);
  Rng rng(5);
  for (int i = 0; i < 2000; ++i) {
    const auto [o, d] = RandomRay(rng);
    const OracleHit expected = CastAll(scene, o, d.normalized());
    if (expected.edge < 1e-4 || expected.second - expected.t < 1e-3) continue;
    const auto hit = caster.Cast(o, d, 100);
    ASSERT_TRUE(hit.has_value());
    ASSERT_NEAR(hit->distance_m, expected.t, 1e-4);
    ASSERT_EQ(hit->instance, expected.instance);
    ASSERT_FALSE(caster.Cast(o, d, expected.t * 0.99).has_value());
  }
}

/// Rounded to float. GCC 12 optimises the conversion of a double to float and back away; `volatile`
/// prevents it.
Vector3d Single(const Vector3d& p) {
  volatile float x = static_cast<float>(p.x()), y = static_cast<float>(p.y()),
                 z = static_cast<float>(p.z());
  return {x, y, z};
}

// Embree's own distance differs in its last bits from one processor to another, and with them a
// whole episode.
TEST(RayCaster, DistancesDoNotDependOnTheProcessor) {
  const Scene scene = RandomTriangles(13);
  const RayCaster caster(scene);
  Rng rng(6);
  for (int i = 0; i < 2000; ++i) {
    const auto [o, d] = RandomRay(rng);
    const auto hit = caster.Cast(o, d, 100);
    if (!hit) continue;
    const auto& corner = scene.mesh.triangles[hit->triangle];
    const auto at = [&](int k) { return Vector3d(scene.mesh.vertices[corner[k]].cast<double>()); };
    const Vector3d a = at(0), n = (at(1) - a).cross(at(2) - a);
    const Vector3d ray = Single(d / d.norm()), from = Single(o);
    if (std::abs(n.dot(ray)) < 1e-3 * n.norm()) continue;
    ASSERT_EQ(hit->distance_m, static_cast<float>((n.dot(a) - n.dot(from)) / n.dot(ray)));
  }
}

TEST(RayCaster, RaysMeetTheSameWithOtherInstructions) {
  const Scene scene = RandomTriangles(14);
  const RayCaster caster(scene);
  for (const char* instructions : {"sse2", "avx"}) {
    const RayCaster other(scene, instructions);
    Rng rng(8);
    for (int i = 0; i < 20000; ++i) {
      const auto [o, d] = RandomRay(rng);
      const auto a = caster.Cast(o, d, 100), b = other.Cast(o, d, 100);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      ASSERT_EQ(a->distance_m, b->distance_m) << instructions;
      ASSERT_EQ(a->triangle, b->triangle) << instructions;
    }
  }
}

// The days of a lifelong suite were others on an AMD than on an Intel processor: the processor's
// estimates decided which of several surfaces in one plane a ray meets.
TEST(RayCaster, OfSurfacesInOnePlaneTheFirstIsHitWithEveryInstructionSet) {
  MicroScene m;
  const int floor = m.Begin("floor");
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) m.Ground(0.3 * x, 0.3 * y, 0.3 * (x + 1), 0.3 * (y + 1));
  }
  m.Begin("rug");
  m.Ground(0.45, 0.3, 1.73, 1.91);
  m.Begin("underside");
  m.Quad({0.1, 0.1, 0}, {0.1, 2.1, 0}, {2.3, 2.1, 0}, {2.3, 0.1, 0});
  const Scene scene = m.Finish();
  for (const char* instructions : {"sse2", "avx", "avx2"}) {
    const RayCaster caster(scene, instructions);
    Rng rng(9);
    for (int i = 0; i < 20000; ++i) {
      const Vector3d to{0.15 * rng.Int(1, 14), 0.15 * rng.Int(1, 14), 0};
      Vector3d from = to;
      from.z() = 0.01 * rng.Int(1, 300);
      if (i % 2 == 0) from += Vector3d{rng.Uniform(-1, 1), rng.Uniform(-1, 1), 0};
      const auto hit = caster.Cast(from, to - from, 10);
      ASSERT_TRUE(hit.has_value()) << instructions;
      ASSERT_EQ(hit->instance, floor) << instructions << ", ray " << i;
      ASSERT_NEAR(hit->distance_m, (to - from).norm(), 1e-6);
    }
  }
}

TEST(RayCaster, DepthIsPlanarAndImageAxesAreThoseOfTheCamera) {
  MicroScene m;
  m.Begin("wall");
  m.Quad({2, -9, -9}, {2, 9, -9}, {2, 9, 9}, {2, -9, 9});
  const int left = m.Begin("left");
  m.Quad({1.9, 0.5, -0.2}, {1.9, 0.9, -0.2}, {1.9, 0.9, 0.2}, {1.9, 0.5, 0.2});
  const int top = m.Begin("top");
  m.Quad({1.9, -0.2, 0.5}, {1.9, 0.2, 0.5}, {1.9, 0.2, 0.9}, {1.9, -0.2, 0.9});
  const Scene scene = m.Finish();
  const RayCaster caster(scene);
  const CameraIntrinsics K = IntrinsicsFromHfov(65, 65, DegToRad(90));
  const Frame frame = caster.Render(K, CameraPose({}, 0));
  EXPECT_FLOAT_EQ(frame.depth_m.At(32, 32), 2);
  EXPECT_FLOAT_EQ(frame.depth_m.At(0, 64), 2);  // not the longer ray length
  EXPECT_EQ(frame.instance.At(32 - 12, 32), left);
  EXPECT_EQ(frame.instance.At(32, 32 - 12), top);
}

TEST(RayCaster, WhereNothingIsHitDepthAndInstanceAreZero) {
  MicroScene m;
  m.Begin("floor");
  m.Ground(-1, -1, 1, 1);
  const Scene scene = m.Finish();
  const RayCaster caster(scene);
  const Frame frame = caster.Render(IntrinsicsFromHfov(16, 16, DegToRad(90)), CameraPose({}, 0.88));
  EXPECT_EQ(frame.depth_m.At(8, 0), 0);
  EXPECT_EQ(frame.instance.At(8, 0), 0);
  EXPECT_GT(frame.depth_m.At(8, 15), 0);
  EXPECT_FALSE(caster.Cast({0, 0, 1}, {0, 0, 1}, 100).has_value());
  EXPECT_FALSE(caster.Cast({0, 0, 1}, {0, 0, 0}, 100).has_value());
  EXPECT_FALSE(caster.Cast({0, 0, NAN}, {0, 0, -1}, 100).has_value());
}

/// A square at x = 2 facing the origin, with texture coordinates u to the right and v down.
Scene TexturedSquare(const Texture& texture) {
  MicroScene m;
  m.Begin("square");
  m.Quad({2, 1, 1}, {2, -1, 1}, {2, -1, -1}, {2, 1, -1});
  m.scene().mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  m.scene().materials = {Material{{255, 255, 255}, 0}};
  m.scene().textures = {texture};
  m.SetMaterial(0);
  return m.Finish();
}

TEST(RayCaster, TexturesLieWhereTheirCoordinatesSay) {
  Texture texture;
  texture.rgb = RgbImage(2, 2, {10, 10, 10});
  texture.rgb.At(1, 0) = {250, 10, 10};  // top right
  texture.rgb.At(0, 1) = {10, 10, 250};  // bottom left
  const Scene scene = TexturedSquare(texture);
  const RayCaster caster(scene);
  const Frame frame = caster.Render(IntrinsicsFromHfov(64, 64, DegToRad(90)), CameraPose({}, 0));
  const Rgb8 top_right = frame.rgb.At(39, 24), bottom_left = frame.rgb.At(24, 39);
  EXPECT_GT(top_right.r, 100);
  EXPECT_LT(top_right.b, 40);
  EXPECT_GT(bottom_left.b, 100);
  EXPECT_LT(bottom_left.r, 40);
  EXPECT_LT(frame.rgb.At(24, 24).r, 40);
}

TEST(RayCaster, UnlitSurfacesKeepTheirColoursFromEverySide) {
  Texture texture;
  texture.rgb = RgbImage(1, 1, {200, 150, 100});
  Scene scene = TexturedSquare(texture);
  const auto colour_at_centre = [&scene] {
    const RayCaster caster(scene);
    const Frame frame = caster.Render(IntrinsicsFromHfov(3, 3, DegToRad(90)), CameraPose({}, 0));
    const auto hit = caster.Cast({0, 0.9, 0}, {1, -0.4, 0}, 10);  // aslant
    EXPECT_EQ(hit->colour == Rgb8({200, 150, 100}), scene.materials[0].is_unlit);
    return frame.rgb.At(1, 1);
  };
  EXPECT_LT(colour_at_centre().r, 190);
  scene.materials[0].is_unlit = true;
  EXPECT_EQ(colour_at_centre(), (Rgb8{200, 150, 100}));
  scene.materials[0] = {{200, 150, 100}, -1, true};
  EXPECT_EQ(colour_at_centre(), (Rgb8{200, 150, 100}));
}

TEST(RayCaster, HolesOfATextureLetRaysThrough) {
  Texture texture;
  texture.rgb = RgbImage(2, 1, {200, 200, 200});
  texture.opaque = MaskImage(2, 1, 1);
  texture.opaque.At(0, 0) = 0;  // the left half is a hole
  Scene scene = TexturedSquare(texture);
  const RayCaster caster(scene);
  const Frame frame = caster.Render(IntrinsicsFromHfov(64, 64, DegToRad(90)), CameraPose({}, 0));
  EXPECT_EQ(frame.depth_m.At(24, 32), 0);
  EXPECT_FLOAT_EQ(frame.depth_m.At(39, 32), 2);
  EXPECT_FALSE(caster.Cast({0, 0.5, 0}, {1, 0, 0}, 10).has_value());
  EXPECT_TRUE(caster.Cast({0, -0.5, 0}, {1, 0, 0}, 10).has_value());
}

// Embree's limit of one thread held for all that uses TBB in the process, OpenVINO first of all.
TEST(RayCaster, LeavesOthersTheirThreads) {
  const auto limit = tbb::global_control::max_allowed_parallelism;
  const std::size_t before = tbb::global_control::active_value(limit);
  MicroScene micro;
  micro.Room(0, 0, 6, 6);
  const Scene scene = micro.Finish();
  const RayCaster caster(scene);
  EXPECT_EQ(tbb::global_control::active_value(limit), before);
}

}  // namespace
}  // namespace crossnav::sim::test
