// SPDX-License-Identifier: MIT
#include "crossnav/geometry/flying_pixels.h"

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {
namespace {

constexpr int kSide_px = 64;

/// A post of 2 m before a wall at 5 m.
DepthImage PostBeforeWall(int post_px = 8) {
  DepthImage depth_m(kSide_px, kSide_px, 5.0F);
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 20; u < 20 + post_px; ++u) depth_m.At(u, v) = 2.0F;
  return depth_m;
}

TEST(FlyingPixels, ReadingsBetweenTwoSurfacesAreDropped) {
  DepthImage depth_m = PostBeforeWall();
  for (int v = 4; v < kSide_px; v += 6) depth_m.At(28, v) = 3.2F;
  const DepthImage kept = WithoutFlyingPixels(depth_m, 2);
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 0; u < kSide_px; ++u)
      EXPECT_EQ(kept.At(u, v), depth_m.At(u, v) == 3.2F ? 0.0F : depth_m.At(u, v)) << u << " " << v;
}

TEST(FlyingPixels, PerfectDepthIsKeptDownToALineOfOnePixel) {
  const DepthImage depth_m = PostBeforeWall(1), kept = WithoutFlyingPixels(depth_m, 2);
  for (int v = 1; v + 1 < kSide_px; ++v)  // the ends of a line have one neighbour
    for (int u = 0; u < kSide_px; ++u) EXPECT_EQ(kept.At(u, v), depth_m.At(u, v)) << u << " " << v;
}

TEST(FlyingPixels, TheNoiseOfASurfaceIsKept) {
  Rng rng(1);
  DepthImage depth_m(kSide_px, kSide_px, 0.0F);
  int kept = 0;
  for (float& z_m : depth_m.data) z_m = static_cast<float>(4 + 0.0037 * 16 * rng.Normal());
  for (const float z_m : WithoutFlyingPixels(depth_m, 2).data) kept += z_m > 0 ? 1 : 0;
  EXPECT_GE(kept, 0.999 * kSide_px * kSide_px);
}

/// Literal reading of the definition.
DepthImage ByDefinition(const DepthImage& depth_m, int min_neighbours) {
  DepthImage kept = depth_m;
  for (int v = 0; v < depth_m.height; ++v) {
    for (int u = 0; u < depth_m.width; ++u) {
      const float z_m = depth_m.At(u, v);
      int confirming = 0;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
          if ((du != 0 || dv != 0) && depth_m.Contains(u + du, v + dv) &&
              std::abs(depth_m.At(u + du, v + dv) - z_m) <= (0.03F + 0.01F * z_m) * z_m)
            ++confirming;
      if (z_m > 0 && confirming < min_neighbours) kept.At(u, v) = 0;
    }
  }
  return kept;
}

TEST(FlyingPixels, AgreeWithTheDefinitionInImagesOfAnySize) {
  Rng rng(2);
  for (const int width : {1, 2, 3, 5, 33, 64}) {
    for (const int height : {1, 2, 3, 17}) {
      DepthImage depth_m(width, height, 0.0F);
      for (float& z_m : depth_m.data)
        if (rng.Uniform() > 0.2) z_m = static_cast<float>(2 + 0.1 * rng.Normal());
      for (const int min_neighbours : {0, 1, 2, 3, 8})
        EXPECT_EQ(WithoutFlyingPixels(depth_m, min_neighbours).data,
                  ByDefinition(depth_m, min_neighbours).data)
            << width << " x " << height << ", " << min_neighbours;
    }
  }
}

TEST(FlyingPixels, WithoutANumberOfNeighboursEveryReadingIsKept) {
  DepthImage depth_m(3, 3, 0.0F);
  depth_m.At(1, 1) = 2;
  EXPECT_EQ(WithoutFlyingPixels(depth_m, 0).data, depth_m.data);
}

TEST(FlyingPixels, AreNoSurfacesOfAMapOfARealSensor) {
  const auto surfaces_between = [](const std::string& clearing, int min_neighbours) {
    MapConfig config;
    config.clearing = clearing;
    config.min_neighbours = min_neighbours;
    config.min_hits = 1;
    VoxelMap map(config);
    DepthImage depth_m = PostBeforeWall();
    for (int v = 4; v < kSide_px; v += 6) depth_m.At(28, v) = 3.2F;
    const CameraIntrinsics camera{kSide_px, kSide_px, 32, 32, 31.5, 31.5};
    const Pose T_world_camera = Pose::Identity();
    map.Integrate(depth_m, camera, T_world_camera);
    map.UpdateStates();
    int between = 0;
    map.ForEach([&](const VoxelKey& key, const Voxel& voxel) {
      const double z_m = CenterOf(key, config.voxel_m).z();
      between += voxel.state == VoxelState::kOccupied && z_m > 2.5 && z_m < 4.5 ? 1 : 0;
    });
    return between;
  };
  const int fallback = MapConfig{}.min_neighbours;
  EXPECT_GT(surfaces_between("never", fallback), 5) << "a perfect sensor has none";
  EXPECT_GT(surfaces_between("evidence", 0), 5);
  EXPECT_EQ(surfaces_between("evidence", fallback), 0);
}

}  // namespace
}  // namespace crossnav::geometry
