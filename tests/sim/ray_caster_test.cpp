// SPDX-License-Identifier: MIT
#include "crossnav/sim/ray_caster.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "crossnav/core/rng.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

struct OracleHit {
  double t = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();  // next different surface
  double edge = 0;  // smallest barycentric coordinate of the hit, and of near misses
  std::int32_t instance = 0;
};

/// Every triangle against one ray, in double precision. `edge` says how near the ray passes to any
/// triangle's edge: such rays may fall on either side in single precision.
OracleHit CastAll(const Scene& scene, const Vector3d& o, const Vector3d& d) {
  OracleHit hit;
  hit.edge = 1;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const auto& c = scene.mesh.triangles[t];
    const Vector3d a = scene.mesh.vertices[c[0]].cast<double>();
    const Vector3d e1 = scene.mesh.vertices[c[1]].cast<double>() - a;
    const Vector3d e2 = scene.mesh.vertices[c[2]].cast<double>() - a;
    const Vector3d n = e1.cross(e2);
    const double det = -d.dot(n);
    if (std::abs(det) < 1e-14) continue;
    const double distance = (o - a).dot(n) / det;
    const Vector3d dao = (o - a).cross(d);
    const double u = e2.dot(dao) / det, v = -e1.dot(dao) / det;
    const double inside = std::min({u, v, 1 - u - v});
    if (distance <= 0) continue;
    if (std::abs(inside) < 1e-4) hit.edge = std::min(hit.edge, std::abs(inside));
    if (inside < 0) continue;
    if (distance < hit.t) {
      hit.second = hit.t;
      hit.t = distance;
      hit.instance = scene.mesh.triangle_instance[t];
    } else {
      hit.second = std::min(hit.second, distance);
    }
  }
  return hit;
}

Scene RandomTriangles(std::uint64_t seed) {
  Rng rng(seed);
  MicroScene m;
  m.Room(-3, -3, 3, 3);
  const auto point = [&rng] {
    return Vector3d(rng.Uniform(-3, 3), rng.Uniform(-3, 3), rng.Uniform(0, 2.6));
  };
  for (int i = 0; i < 60; ++i) {
    m.Begin("thing");
    const Vector3d a = point();
    const auto near = [&] { return Vector3d(a + 0.3 * (point() - point())); };
    const Vector3d b = near(), c = near();
    m.Triangle(a, b, c);
  }
  return m.Finish();
}

struct Ray {
  Vector3d origin, direction;
};

Ray RandomRay(Rng& rng) {
  const Vector3d o(rng.Uniform(-2, 2), rng.Uniform(-2, 2), rng.Uniform(0.1, 2.5));
  const Vector3d d(rng.Normal(), rng.Normal(), rng.Normal());
  return {o, d};
}

TEST(RayCaster, PacketsAgreeWithBruteForceOverAllTriangles) {
  const Scene scene = RandomTriangles(11);
  const RayCaster caster(scene);
  // A size that is no multiple of the packet's tile.
  const CameraIntrinsics K = IntrinsicsFromHfov(61, 47, DegToRad(90));
  int compared = 0;
  for (int view = 0; view < 4; ++view) {
    const AgentPose agent{{0.3 * view - 0.5, 0.2, 0.1}, 1.3 * view, 0.2 * view - 0.3};
    const Pose T = CameraPose(agent, 0.88);
    const Frame frame = caster.Render(K, T);
    for (int v = 0; v < K.height_px; ++v) {
      for (int u = 0; u < K.width_px; ++u) {
        const Vector3d d = T.linear() * BackProjectPixel(K, u, v, 1.0);
        const OracleHit hit = CastAll(scene, T.translation(), d);
        if (hit.edge < 1e-4 || hit.second - hit.t < 1e-3) continue;  // ambiguous in float
        ++compared;
        ASSERT_NEAR(frame.depth_m.At(u, v), hit.t, 1e-4 * hit.t + 1e-5) << u << ',' << v;
        ASSERT_EQ(frame.instance.At(u, v), hit.instance) << u << ',' << v;
      }
    }
  }
  EXPECT_GT(compared, 4 * 61 * 47 * 9 / 10);
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

/// Rounded to float. GCC 12 turns pairs of doubles that become float and double again into what
/// they were; `volatile` keeps it from that.
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

// With Embree's own distances 216,362 of the 614,400 pixels differ here from AVX2's, in their last
// bits.
TEST(RayCaster, FramesAreTheSameWithOtherInstructions) {
  const Scene scene = RandomTriangles(14);
  const RayCaster caster(scene);
  const CameraIntrinsics K = IntrinsicsFromHfov(320, 240, DegToRad(90));
  for (const char* instructions : {"sse2", "avx"}) {
    const RayCaster other(scene, instructions);
    std::size_t differing = 0, pixels = 0;
    for (int view = 0; view < 8; ++view) {
      const Pose T = CameraPose({{0.3 * view - 1, 0.2, 0.1}, 0.8 * view, 0.1 * view - 0.4}, 0.88);
      const Frame a = caster.Render(K, T), b = other.Render(K, T);
      for (std::size_t i = 0; i < a.depth_m.data.size(); ++i)
        differing +=
            a.depth_m.data[i] != b.depth_m.data[i] || a.instance.data[i] != b.instance.data[i];
      pixels += a.depth_m.data.size();
    }
    EXPECT_EQ(differing, 0u) << "of " << pixels << " pixels with " << instructions;
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

TEST(RayCaster, TwoRendersAreByteIdentical) {
  const Scene scene = RandomTriangles(13);
  const RayCaster caster(scene), other(scene);
  const CameraIntrinsics K = IntrinsicsFromHfov(80, 80, DegToRad(90));
  const Frame a = caster.Render(K, CameraPose({}, 0.88)), b = other.Render(K, CameraPose({}, 0.88));
  EXPECT_EQ(a.rgb.data, b.rgb.data);
  EXPECT_EQ(a.depth_m.data, b.depth_m.data);
  EXPECT_EQ(a.instance.data, b.instance.data);
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
