// SPDX-License-Identifier: MIT
// Statistics of a camera whose noise is known.
#include "crossnav/evaluation/episodes/depth_statistics.h"

#include <gtest/gtest.h>

#include "crossnav/sim/sensing/sensor_noise.h"

namespace crossnav::evaluation {
namespace {

constexpr CameraIntrinsics kCamera = {200, 150, 150, 150, 99.5, 74.5};

Observation Look(const DepthImage& depth_m) {
  Observation obs;
  obs.camera = kCamera;
  obs.depth_m = depth_m;
  obs.rgb = RgbImage(depth_m.width, depth_m.height, {200, 200, 200});
  return obs;
}

TEST(DepthStatistics, TellTheSigmaOfAWall) {
  sim::NoiseConfig noise;
  noise.depth_sigma_m = 0.004;
  DepthStatistics statistics;
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    AddFrame(Look(sim::NoisyDepth(noise, DepthImage(200, 150, 1.5F), seed)), &statistics);
  EXPECT_NEAR(statistics.SigmaOf(1, 0), 0.004, 0.0004);  // 1 to 2 m, under 30 degrees
  EXPECT_EQ(statistics.SigmaOf(3, 0), 0);
  EXPECT_EQ(statistics.edges, 0);
}

TEST(DepthStatistics, TellWhatIsLostInTheDarkAndWhatFliesAtEdges) {
  DepthImage depth_m(200, 150, 1.0F);
  for (int v = 0; v < 150; ++v)
    for (int u = 99; u < 200; ++u)  // half of the edge flies, in a column that is looked at
      depth_m.At(u, v) = u == 99 && v < 75 ? 2.0F : 3.0F;
  Observation obs = Look(depth_m);
  for (int v = 0; v < 75; ++v)
    for (int u = 0; u < 50; ++u) {
      obs.rgb.At(u, v) = {0, 0, 0};
      obs.depth_m.At(u, v) = 0;
    }
  DepthStatistics statistics;
  AddFrame(obs, &statistics);
  EXPECT_EQ(statistics.lost[0], statistics.lit[0]);
  EXPECT_GT(statistics.lost[0], 100);
  EXPECT_EQ(statistics.lost[3], 0);
  EXPECT_GT(statistics.edges, 40);
  EXPECT_GT(statistics.flying, 10);
  EXPECT_LT(statistics.flying, statistics.edges);
}

}  // namespace
}  // namespace crossnav::evaluation
