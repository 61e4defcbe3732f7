// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/rasterizer.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <thread>

#include "crossnav/core/rng.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/render/triangle_clusters.h"
#include "micro_scene.h"
#include "ray_oracle.h"

namespace crossnav::sim::test {
namespace {

struct Comparison {
  int compared = 0, ambiguous = 0;
};

/// Every pixel against every triangle; pixels that are ambiguous in float are left out.
void CompareWithBruteForce(const Scene& scene, const CameraIntrinsics& K, const Pose& T,
                           Comparison& so_far) {
  const Frame frame = Rasterizer(scene).Render(K, T, Channels::kWithoutColour);
  for (int v = 0; v < K.height_px; ++v) {
    for (int u = 0; u < K.width_px; ++u) {
      const Vector3d d = T.linear() * BackProjectPixel(K, u, v, 1.0);
      const OracleHit hit = CastAll(scene, T.translation(), d);
      if (hit.edge < 1e-4 || hit.second - hit.t < 1e-3) {
        ++so_far.ambiguous;
        continue;
      }
      ++so_far.compared;
      const double depth_m = std::isinf(hit.t) ? 0 : hit.t;
      ASSERT_NEAR(frame.depth_m.At(u, v), depth_m, 1e-4 * depth_m + 1e-5) << u << ',' << v;
      ASSERT_EQ(frame.instance.At(u, v), hit.instance) << u << ',' << v;
    }
  }
}

// Sizes that are no multiple of a vector or of a tile, and one pixel.
TEST(Rasterizer, EveryPixelEqualsBruteForceOverAllTriangles) {
  Comparison all;
  for (const int count : {60, 1500}) {
    const Scene scene = RandomTriangles(11, count);
    for (int view = 0; view < 6; ++view) {
      const Pose T = CameraPose({{0.3 * view - 0.5, 0.2, 0.1}, 1.3 * view, 0.2 * view - 0.3}, 0.88);
      for (const auto& [width, height] : {std::pair{61, 47}, {8, 9}, {1, 1}})
        CompareWithBruteForce(scene, IntrinsicsFromHfov(width, height, DegToRad(90)), T, all);
    }
  }
  EXPECT_GT(all.compared, 9 * all.ambiguous);
}

// Pictures of several blocks of tiles, in which near triangles hide parts of tiles and whole
// blocks.
TEST(Rasterizer, TilesAndBlocksHideTheSameTrianglesAsBruteForce) {
  Comparison all;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    MicroScene m;
    for (int i = 0; i < 260; ++i) {  // several clusters; some as wide as the picture, most narrow
      m.Begin("thing");
      const double distance_m = rng.Uniform(1, 6), reach = rng.Chance(0.15) ? 4 : 0.4;
      const Vector3d centre(distance_m, distance_m * rng.Uniform(-0.9, 0.9),
                            distance_m * rng.Uniform(-0.6, 0.6));
      const auto point = [&] {
        return Vector3d(centre + reach * Vector3d(0.1 * rng.Normal(), rng.Normal(), rng.Normal()));
      };
      const Vector3d a = point(), b = point(), c = point();
      m.Triangle(a, b, c);
    }
    CompareWithBruteForce(m.Finish(), IntrinsicsFromHfov(203, 139, DegToRad(90)),
                          CameraPose({{0, 0, 0}, 0, 0}, 0), all);
  }
  EXPECT_GT(all.compared, 9 * all.ambiguous);
}

// Triangles that reach behind the camera have no box on the picture.
TEST(Rasterizer, TrianglesAroundTheCameraEqualBruteForce) {
  Comparison all;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed);
    MicroScene m;
    const Pose T = CameraPose({{0.4, -0.2, 0}, 0.7, 0.1}, 0.88);
    for (int i = 0; i < (seed <= 4 ? 24 : 200); ++i) {
      m.Begin("thing");
      const double reach = i % 3 == 0 ? 5 : (i % 3 == 1 ? 0.5 : 0.1);
      const auto point = [&] {
        return Vector3d(T.translation() +
                        reach * Vector3d(rng.Normal(), rng.Normal(), rng.Normal()));
      };
      const Vector3d a = point(), b = point(), c = point();
      m.Triangle(a, b, c);
    }
    CompareWithBruteForce(m.Finish(), IntrinsicsFromHfov(83, 40, DegToRad(110)), T, all);
  }
  EXPECT_GT(all.compared, 3 * all.ambiguous);
}

/// A ball of many triangles that share their corners.
Scene Ball(int rings, double radius_m) {
  MicroScene m;
  m.Begin("ball");
  const auto at = [&](int i, int k) {
    const double polar = std::numbers::pi * i / rings,
                 around = std::numbers::pi * (k % (2 * rings)) / rings;
    const double r = i == 0 || i == rings ? 0 : radius_m * std::sin(polar);
    return Vector3d(r * std::cos(around), r * std::sin(around), radius_m * std::cos(polar));
  };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < 2 * rings; ++k) {
      if (i > 0) m.Triangle(at(i, k), at(i + 1, k), at(i, k + 1));
      if (i + 1 < rings) m.Triangle(at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
    }
  return m.Finish();
}

TEST(Rasterizer, NoPixelFallsBetweenNeighbours) {
  for (const int rings : {5, 40, 300}) {
    const Scene scene = Ball(rings, 3);
    const Rasterizer rasterizer(scene);
    for (int view = 0; view < 10; ++view) {
      const Pose T =
          CameraPose({{0.1 * view, 0.07 * view, 0.03}, 0.37 * view, 0.1 * view - 0.5}, 0);
      const Frame frame = rasterizer.Render(IntrinsicsFromHfov(160, 160, DegToRad(90)), T,
                                            Channels::kWithoutColour);
      for (const float depth_m : frame.depth_m.data) ASSERT_GT(depth_m, 0);
    }
  }
}

// Walls of neighbouring rooms may lie in one plane; they came out as a pattern of both.
TEST(Rasterizer, OneOfTwoCoincidentSurfacesIsShown) {
  MicroScene m;
  m.Begin("wall");
  m.Quad({2, -1, -1}, {2.3, 1.1, -1}, {2.3, 1.1, 1}, {2, -1, 1});
  const int other = m.Begin("other wall");  // other triangles of the same plane
  m.Quad({2.3, 1.1, 1}, {2, -1, 1}, {2, -1, -1}, {2.3, 1.1, -1});
  const Scene scene = m.Finish();
  const Frame frame =
      Rasterizer(scene).Render(IntrinsicsFromHfov(160, 160, DegToRad(90)),
                               CameraPose({{0, 0, 0}, 0.2, 0.1}, 0), Channels::kWithoutColour);
  const auto count = [&](int instance) {
    return std::count(frame.instance.data.begin(), frame.instance.data.end(), instance);
  };
  EXPECT_GT(count(other - 1), 2000);
  EXPECT_EQ(count(other), 0);
}

/// Textures, colours at the corners, holes.
Scene Colourful(std::uint64_t seed) {
  Scene scene = RandomTriangles(seed, 300);
  Rng rng(seed);
  const auto byte = [&rng] { return static_cast<std::uint8_t>(rng.Uniform(0, 255.99)); };
  for (int i = 0; i < 2; ++i) {
    Texture texture;
    texture.rgb = RgbImage(4, 4);
    for (Rgb8& p : texture.rgb.data) p = {byte(), byte(), byte()};
    if (i == 1) {
      texture.opaque = MaskImage(4, 4, 1);
      texture.opaque.At(1, 2) = texture.opaque.At(3, 0) = 0;
    }
    scene.textures.push_back(texture);
  }
  scene.materials = {{{200, 100, 50}, -1}, {{255, 255, 255}, 0}, {{255, 255, 255}, 1}};
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
    scene.mesh.triangle_material[t] = static_cast<std::uint16_t>(t % 3);
  for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
    scene.mesh.uvs.push_back(
        {static_cast<float>(rng.Uniform(-1, 1)), static_cast<float>(rng.Uniform(-1, 1))});
    scene.mesh.vertex_colours.push_back({byte(), byte(), byte()});
  }
  return scene;
}

TEST(Rasterizer, ColoursDepthsAndHolesEqualRays) {
  const Scene scene = Colourful(3);
  const RayCaster caster(scene);
  const Rasterizer rasterizer(scene);
  const CameraIntrinsics K = IntrinsicsFromHfov(101, 77, DegToRad(90));
  int other_surface = 0, other_colour = 0, all = 0;
  for (int view = 0; view < 6; ++view) {
    const Pose T = CameraPose({{0.3 * view - 0.5, 0.2, 0.1}, 1.3 * view, 0.2 * view - 0.3}, 0.88);
    const Frame frame = rasterizer.Render(K, T, Channels::kAll);
    for (int v = 0; v < K.height_px; ++v) {
      for (int u = 0; u < K.width_px; ++u, ++all) {
        const Vector3d d = T.linear() * BackProjectPixel(K, u, v, 1.0);
        const auto hit = caster.Cast(T.translation(), d, 100);
        const double depth_m = hit ? hit->distance_m / d.norm() : 0;
        if (std::abs(frame.depth_m.At(u, v) - depth_m) > 1e-4 ||
            frame.instance.At(u, v) != (hit ? hit->instance : 0)) {
          ++other_surface;
          continue;
        }
        const Rgb8 expected = hit ? hit->colour : Rgb8{}, seen = frame.rgb.At(u, v);
        const int off = std::max({std::abs(expected.r - seen.r), std::abs(expected.g - seen.g),
                                  std::abs(expected.b - seen.b)});
        other_colour += off > 2;
      }
    }
  }
  EXPECT_LT(other_surface, all / 1000);  // at edges
  EXPECT_LT(other_colour, all / 1000);   // seen edge-on, where textures run fast
}

bool operator==(const Frame& a, const Frame& b) {
  return a.rgb.data == b.rgb.data && a.depth_m.data == b.depth_m.data &&
         a.instance.data == b.instance.data;
}

TEST(Rasterizer, PicturesAreTheSameOnEveryInstructionSetAndInEveryThread) {
  const Scene scene = Colourful(4);
  const Rasterizer rasterizer(scene);
  const CameraIntrinsics K = IntrinsicsFromHfov(75, 61, DegToRad(90));
  const auto view = [](int i) {
    return CameraPose({{0.3 * i - 1, 0.2, 0.1}, 0.8 * i, 0.1 * i - 0.4}, 0.88);
  };
  std::array<Frame, 8> expected;
  for (int i = 0; i < 8; ++i)
    expected[static_cast<std::size_t>(i)] = rasterizer.Render(K, view(i), Channels::kAll);
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    hwy::GetChosenTarget().DeInit();
    for (int i = 0; i < 8; ++i)
      EXPECT_TRUE(rasterizer.Render(K, view(i), Channels::kAll) ==
                  expected[static_cast<std::size_t>(i)])
          << "view " << i << ", target " << (left & -left);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  std::vector<std::thread> threads;
  std::array<bool, 8> is_same{};
  for (std::size_t i = 0; i < 8; ++i)
    threads.emplace_back([&, i] {
      is_same[i] = rasterizer.Render(K, view(static_cast<int>(i)), Channels::kAll) == expected[i];
    });
  for (std::thread& thread : threads) thread.join();
  for (const bool same : is_same) EXPECT_TRUE(same);
}

TEST(Rasterizer, ASceneWithoutTrianglesIsAnEmptyPicture) {
  Scene scene;
  UpdateDerived(scene);
  const Frame frame =
      Rasterizer(scene).Render(IntrinsicsFromHfov(9, 9, 1), CameraPose({}, 0), Channels::kAll);
  EXPECT_EQ(frame.depth_m.data, std::vector<float>(81));
}

TEST(TriangleClusters, EveryTriangleIsInOneClusterAndInItsBox) {
  const Scene scene = RandomTriangles(5, 1000);
  std::vector<bool> has_holes(scene.mesh.triangles.size());
  for (std::size_t t = 0; t < has_holes.size(); t += 7) has_holes[t] = true;
  const TriangleClusters all = ClusterTriangles(scene.mesh, has_holes);
  std::multiset<std::uint32_t> found;
  for (const Cluster& cluster : all.clusters) {
    for (std::uint32_t i = 0; i < cluster.count * 8; ++i) {
      const Octet& octet = all.octets[cluster.first + i / 8];
      const std::size_t lane = i % 8;
      const auto at = [&](std::size_t corner) {
        return Vector3f(octet.corners[corner][0][lane], octet.corners[corner][1][lane],
                        octet.corners[corner][2][lane]);
      };
      if (at(0).isZero() && at(1).isZero() && at(2).isZero()) continue;  // an empty lane
      const std::uint32_t t = octet.triangle[lane];
      found.insert(t);
      EXPECT_EQ(has_holes[t], cluster.has_holes);
      EXPECT_EQ(octet.instance[lane], scene.mesh.triangle_instance[t]);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(at(corner), scene.mesh.vertices[scene.mesh.triangles[t][corner]]);
        EXPECT_TRUE(
            ((at(corner) - cluster.centre).cwiseAbs().array() <= cluster.half.array()).all());
      }
    }
  }
  EXPECT_EQ(found.size(), scene.mesh.triangles.size());
  EXPECT_EQ(std::set(found.begin(), found.end()).size(), found.size());
}

}  // namespace
}  // namespace crossnav::sim::test
