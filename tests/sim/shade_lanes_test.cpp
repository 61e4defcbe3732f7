// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/shade_lanes.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/sim/render/shading.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

int Below(Rng& rng, int n) {
  return std::min(static_cast<int>(rng.Uniform(0, n)), n - 1);
}

Rgb8 AnyColour(Rng& rng) {
  const auto byte = [&rng] { return static_cast<std::uint8_t>(Below(rng, 256)); };
  return {byte(), byte(), byte()};
}

enum Parts : unsigned { kTextures = 1, kCorners = 2 };

/// Triangles of all kinds: textured or not, unlit or not, texture coordinates far outside [0, 1).
Scene AnyScene(Rng& rng, unsigned parts) {
  MicroScene m;
  m.Begin("thing");
  for (int i = 0; i < 40; ++i) {
    m.SetMaterial(static_cast<std::uint32_t>(i % 8));
    m.Triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  }
  Scene& scene = m.scene();
  for (int i = 0; i < 8; ++i) {
    Material material{AnyColour(rng), (parts & kTextures) != 0 ? i % 4 - 1 : -1};
    material.is_unlit = i >= 4;
    scene.materials.push_back(material);
  }
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 128}}) {
    Texture texture;
    texture.rgb = RgbImage(width, height);
    for (Rgb8& p : texture.rgb.data) p = AnyColour(rng);
    scene.textures.push_back(texture);
  }
  for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
    const auto at = [&] { return static_cast<float>(rng.Uniform(-3, 3)); };
    if ((parts & kTextures) != 0) scene.mesh.uvs.push_back({at(), at()});
    if ((parts & kCorners) != 0) scene.mesh.vertex_colours.push_back(AnyColour(rng));
  }
  return m.Finish();
}

struct Hits {
  std::array<std::int32_t, kShadeLanes> triangle;
  std::array<float, kShadeLanes> s, t;
  std::array<std::array<float, kShadeLanes>, 3> normal, ray;

  /// Hits on at most `kinds` triangles: the kernel has separate branches for one, a few and many.
  Hits(Rng& rng, const Scene& scene, int kinds) {
    std::vector<std::int32_t> some;
    while (static_cast<int>(some.size()) < kinds)
      some.push_back(Below(rng, static_cast<int>(scene.mesh.triangles.size())));
    for (std::size_t i = 0; i < kShadeLanes; ++i) {
      triangle[i] = some[static_cast<std::size_t>(Below(rng, kinds))];
      s[i] = static_cast<float>(rng.Uniform(0, 1));
      t[i] = static_cast<float>(rng.Uniform(0, 1 - static_cast<double>(s[i])));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        normal[axis][i] = static_cast<float>(rng.Normal());
        ray[axis][i] = static_cast<float>(rng.Normal());
      }
    }
  }

  PacketHits View() const {
    return {triangle.data(),
            s.data(),
            t.data(),
            {normal[0].data(), normal[1].data(), normal[2].data()},
            {ray[0].data(), ray[1].data(), ray[2].data()}};
  }
};

/// One hit's colour after shading.h.
std::uint32_t OneByOne(const Scene& scene, const Hits& hits, std::size_t i) {
  const auto triangle = static_cast<std::uint32_t>(hits.triangle[i]);
  const Colour3f colour = SurfaceColour(scene, triangle, hits.s[i], hits.t[i]);
  const bool is_unlit = scene.materials[scene.mesh.triangle_material[triangle]].is_unlit;
  const float light = is_unlit ? 1
                               : Light({hits.normal[0][i], hits.normal[1][i], hits.normal[2][i]},
                                       {hits.ray[0][i], hits.ray[1][i], hits.ray[2][i]});
  const auto byte = [light](float x) {
    return static_cast<std::uint32_t>(x * light + 0.5F);  // NOLINT: never negative
  };
  return byte(colour.r) | byte(colour.g) << 8 | byte(colour.b) << 16;
}

TEST(ShadeLanes, EveryByteEqualsTheScalarReferenceOnEveryInstructionSet) {
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  std::size_t compared = 0;
  for (const unsigned parts : {0U, unsigned{kTextures}, unsigned{kCorners}, kTextures | kCorners}) {
    Rng rng(7 + parts);
    const Scene scene = AnyScene(rng, parts);
    const Skins skins(scene);
    for (int round = 0; round < 300; ++round) {
      const Hits hits(rng, scene, 1 + round % 10);
      for (std::int64_t left = all; left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & -left);
        hwy::GetChosenTarget().DeInit();
        std::array<std::uint32_t, kShadeLanes> colours;
        ShadePacket(skins, hits.View(), colours);
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().DeInit();
        for (std::size_t i = 0; i < kShadeLanes; ++i, ++compared)
          ASSERT_EQ(colours[i], OneByOne(scene, hits, i))
              << "lane " << i << ", parts " << parts << ", target " << (left & -left);
      }
    }
  }
  EXPECT_GE(compared, 4 * 300 * kShadeLanes);
}

}  // namespace
}  // namespace crossnav::sim::test
