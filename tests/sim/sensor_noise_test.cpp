// SPDX-License-Identifier: MIT
// Each kind of noise against its setting; off changes nothing; the same seed gives the same bytes.
#include "crossnav/sim/sensing/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace crossnav::sim {
namespace {

constexpr int kSize_px = 400;

DepthImage Wall(float z_m) {
  return DepthImage(kSize_px, kSize_px, z_m);
}

/// Left half at 1 m, right half at 3 m.
DepthImage Jump() {
  DepthImage depth_m = Wall(1);
  for (int v = 0; v < kSize_px; ++v) {
    for (int u = kSize_px / 2; u < kSize_px; ++u) depth_m.At(u, v) = 3;
  }
  return depth_m;
}

struct Statistics {
  double mean = 0, sigma = 0;
  int count = 0;
};

template <class Range>
Statistics StatisticsOf(const Range& values) {
  Statistics s;
  double sum = 0, squares = 0;
  for (const double x : values) sum += x, squares += x * x, ++s.count;
  s.mean = sum / s.count;
  s.sigma = std::sqrt(std::max(0.0, squares / s.count - s.mean * s.mean));
  return s;
}

double LostShare(const DepthImage& depth_m) {
  double lost = 0;
  for (const float z_m : depth_m.data) lost += z_m == 0 ? 1 : 0;
  return lost / static_cast<double>(depth_m.data.size());
}

NoiseConfig With(const std::function<void(NoiseConfig&)>& set) {
  NoiseConfig noise;
  set(noise);
  return noise;
}

/// Where the agent ends that walks `moves` times 0.25 m along +x, as it believes.
AgentPose Walk(SensorNoise& noise, int moves) {
  AgentPose pose;
  noise.Start(pose);
  for (int i = 0; i < moves; ++i) {
    pose.p_world.x() += 0.25;
    noise.Moved(Action::kMoveForward, pose);
  }
  return noise.believed();
}

Frame SmallFrame() {
  Frame frame{RgbImage(64, 64, {100, 100, 100}), DepthImage(64, 64, 2), InstanceImage(64, 64, 7)};
  for (int v = 0; v < 64; ++v) frame.rgb.At(32, v) = {255, 255, 255};
  return frame;
}

TEST(SensorNoise, DepthHasTheSigmaOfItsDistance) {
  const NoiseConfig noise = With([](NoiseConfig& c) {
    c.depth_sigma_m = 0.002;
    c.depth_sigma_per_m2 = 0.004;
  });
  for (const float z_m : {1.0F, 3.0F, 6.0F}) {
    const Statistics s = StatisticsOf(NoisyDepth(noise, Wall(z_m), 5).data);
    const double expected_m = 0.002 + 0.004 * z_m * z_m;
    EXPECT_NEAR(s.sigma, expected_m, 0.01 * expected_m) << z_m;
    EXPECT_NEAR(s.mean, z_m, 0.01 * expected_m) << z_m;
  }
}

TEST(SensorNoise, KinectHas14MillimetresAt3MetresBesidesItsSteps) {
  NoiseConfig noise = NoiseOfProfile("kinect");
  EXPECT_NEAR(DepthSigma(noise, 3), 0.014, 0.0002);  // Nguyen et al. 2012
  noise = With([&](NoiseConfig& c) { c.depth_step_per_m2 = noise.depth_step_per_m2; });
  const double step_m = 0.00287 * 9;
  const DepthImage stepped = NoisyDepth(noise, Wall(3), 1);
  for (const float z_m : stepped.data) {
    EXPECT_NEAR(z_m, std::round(3 / step_m) * step_m, 1e-5);
    EXPECT_LE(std::abs(z_m - 3), step_m / 2);
  }
}

TEST(SensorNoise, HolesTakeTheirShareInPatches) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_hole_share = 0.2; });
  double lost = 0;
  int lonely = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const DepthImage depth_m = NoisyDepth(noise, Wall(2), seed);
    lost += LostShare(depth_m) / 20;
    for (int u = 1; u < kSize_px; u += 2) lonely += depth_m.At(u, 0) != depth_m.At(u - 1, 0);
  }
  EXPECT_NEAR(lost, 0.2, 0.01);
  EXPECT_EQ(lonely, 0);
}

TEST(SensorNoise, EdgesAreLostBesideJumpsOnly) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_edge_hole = 0.5; });
  const DepthImage depth_m = NoisyDepth(noise, Jump(), 3);
  int lost = 0, elsewhere = 0;
  for (int v = 0; v < kSize_px; ++v) {
    for (int u = 0; u < kSize_px; ++u) {
      if (depth_m.At(u, v) != 0) continue;
      (u == kSize_px / 2 || u == kSize_px / 2 - 1 ? lost : elsewhere) += 1;
    }
  }
  EXPECT_NEAR(lost, kSize_px, 0.12 * kSize_px);  // half of two columns
  EXPECT_EQ(elsewhere, 0);
}

TEST(SensorNoise, ShiftedPixelsHaveTheDepthOfTheOtherSideByTheNormalLaw) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_shift_px = 2; });
  const DepthImage depth_m = NoisyDepth(noise, Jump(), 4);
  const auto share_of_far = [&](int u) {
    double far = 0;
    for (int v = 0; v < kSize_px; ++v) far += depth_m.At(u, v) == 3 ? 1 : 0;
    return far / kSize_px;
  };
  // Column u looks across the edge if its shift, sigma 2 px, rounds to enough.
  const auto expected = [](double off_px) { return 0.5 * std::erfc(off_px / 2 / std::sqrt(2.0)); };
  EXPECT_NEAR(share_of_far(kSize_px / 2 - 1), expected(0.5), 0.08);
  EXPECT_NEAR(share_of_far(kSize_px / 2 - 3), expected(2.5), 0.06);
  EXPECT_EQ(share_of_far(kSize_px / 2 - 30), 0);
}

TEST(SensorNoise, ThereIsNoDepthBeyondTheRangeAndInvalidStaysInvalid) {
  const NoiseConfig noise = With([](NoiseConfig& c) {
    c.depth_max_m = 4;
    c.depth_sigma_m = 0.01;
  });
  EXPECT_EQ(LostShare(NoisyDepth(noise, Wall(5), 1)), 1);
  EXPECT_EQ(LostShare(NoisyDepth(noise, Wall(3), 1)), 0);
  EXPECT_EQ(LostShare(NoisyDepth(noise, Wall(0), 1)), 1);
}

TEST(SensorNoise, DriftGrowsWithTheRootOfTheSteps) {
  const NoiseConfig noise = With([](NoiseConfig& c) {
    c.drift_xy_m = 0.004;
    c.drift_z_m = 0.002;
  });
  std::vector<double> x_m, y_m, z_m;
  for (std::uint64_t episode = 0; episode < 2000; ++episode) {
    SensorNoise one(noise, episode);
    const Vector3d off = Walk(one, 100).p_world - Vector3d(25, 0, 0);
    x_m.push_back(off.x());
    y_m.push_back(off.y());
    z_m.push_back(off.z());
  }
  EXPECT_NEAR(StatisticsOf(x_m).sigma, 0.04, 0.003);
  EXPECT_NEAR(StatisticsOf(y_m).sigma, 0.04, 0.003);
  EXPECT_NEAR(StatisticsOf(z_m).sigma, 0.02, 0.0015);
  EXPECT_NEAR(StatisticsOf(x_m).mean, 0, 0.004);
}

TEST(SensorNoise, YawDriftBendsTheBelievedPath) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.drift_yaw_deg = 0.2; });
  std::vector<double> yaw_deg, y_m;
  for (std::uint64_t episode = 0; episode < 2000; ++episode) {
    SensorNoise one(noise, episode);
    const AgentPose believed = Walk(one, 100);
    yaw_deg.push_back(RadToDeg(believed.yaw_rad));
    y_m.push_back(believed.p_world.y());
  }
  EXPECT_NEAR(StatisticsOf(yaw_deg).sigma, 2.0, 0.15);
  // A random walk of the yaw, summed: step * sigma * sqrt(n^3 / 3).
  EXPECT_NEAR(StatisticsOf(y_m).sigma, 0.25 * DegToRad(0.2) * std::sqrt(1e6 / 3), 0.05);
}

TEST(SensorNoise, ALoopClosureTakesBackItsShareOfTheErrorAtOnce) {
  const NoiseConfig noise = With([](NoiseConfig& c) {
    c.drift_xy_m = 0.01;
    c.drift_yaw_deg = 0.1;
    c.loop_closure_steps = 50;
    c.loop_closure_gain = 1;
  });
  SensorNoise one(noise, 1);
  AgentPose pose;
  one.Start(pose);
  int closures = 0;
  constexpr int kMoves = 20000;
  for (int i = 0; i < kMoves; ++i) {
    pose.p_world.x() += 0.25;
    one.Moved(Action::kMoveForward, pose);
    closures += (one.believed().p_world - pose.p_world).norm() < 1e-9 ? 1 : 0;
  }
  EXPECT_NEAR(closures, kMoves / 50.0, 60);  // three sigma of a Poisson number
}

TEST(SensorNoise, MovesTurnsAndSlipsHaveTheirSettings) {
  const NoiseConfig noise = With([](NoiseConfig& c) {
    c.forward_sigma = 0.05;
    c.turn_sigma_deg = 2;
    c.slip = 0.1;
  });
  SensorNoise one(noise, 1);
  std::vector<double> moves, turns_deg;
  int slips = 0;
  for (int i = 0; i < 20000; ++i) {
    const double factor = one.MoveFactor();
    if (factor == 0) {
      ++slips;
    } else {
      moves.push_back(factor);
    }
    turns_deg.push_back(RadToDeg(one.TurnError_rad()));
  }
  EXPECT_NEAR(slips, 2000, 130);
  EXPECT_NEAR(StatisticsOf(moves).mean, 1, 0.002);
  EXPECT_NEAR(StatisticsOf(moves).sigma, 0.05, 0.001);
  EXPECT_NEAR(StatisticsOf(turns_deg).sigma, 2, 0.04);
  EXPECT_NEAR(StatisticsOf(turns_deg).mean, 0, 0.06);
}

TEST(SensorNoise, LostFramesAreEmpty) {
  SensorNoise one(With([](NoiseConfig& c) { c.drop = 0.25; }), 1);
  int lost = 0;
  for (int i = 0; i < 4000; ++i) {
    Frame frame = SmallFrame();
    one.Disturb(frame, {}, {});
    if (frame.instance.At(3, 3) == 7) {
      EXPECT_EQ(frame.depth_m.data, SmallFrame().depth_m.data);
      continue;
    }
    ++lost;
    EXPECT_EQ(LostShare(frame.depth_m), 1);
    EXPECT_EQ(frame.rgb.At(32, 0), Rgb8());
  }
  EXPECT_NEAR(lost, 1000, 90);
}

TEST(SensorNoise, ExposureIsLogNormalAndBlurKeepsTheLight) {
  const NoiseConfig exposure = With([](NoiseConfig& c) { c.exposure_stops = 0.3; });
  const RgbImage grey(4, 4, {100, 100, 100});
  std::vector<double> stops;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    stops.push_back(std::log2(NoisyColour(exposure, grey, seed).At(0, 0).r / 100.0));
  }
  EXPECT_NEAR(StatisticsOf(stops).sigma, 0.3, 0.015);
  EXPECT_NEAR(StatisticsOf(stops).mean, 0, 0.02);
  const NoiseConfig blur = With([](NoiseConfig& c) { c.blur_px = 9; });
  int longest = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RgbImage line(64, 1);
    line.At(32, 0) = {252, 252, 252};
    const RgbImage blurred = NoisyColour(blur, line, seed);
    int lit = 0, sum = 0;
    for (const Rgb8& c : blurred.data) lit += c.r > 0 ? 1 : 0, sum += c.r;
    EXPECT_NEAR(sum, 252, lit);  // rounded down
    longest = std::max(longest, lit);
  }
  EXPECT_EQ(longest, 9);
}

constexpr CameraIntrinsics kCamera = {kSize_px, kSize_px, 300, 300, 199.5, 199.5};

/// A wall 2 m ahead whose normal is turned by `angle_deg` from the optical axis.
DepthImage TurnedWall(double angle_deg) {
  DepthImage depth_m(kSize_px, kSize_px, 0.0F);
  for (int v = 0; v < kSize_px; ++v)
    for (int u = 0; u < kSize_px; ++u) {
      const double x = (u - kCamera.cx) / kCamera.fx;
      const double z_m = 2 / (1 - x * std::tan(DegToRad(angle_deg)));
      depth_m.At(u, v) = z_m > 0 && z_m < 6 ? static_cast<float>(z_m) : 0.0F;
    }
  return depth_m;
}

TEST(SensorNoise, SigmaGrowsWithTheAngleByNguyensLaw) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_angle_sigma_m = 0.001; });
  for (const double angle_deg : {30.0, 60.0}) {
    const DepthImage wall = TurnedWall(angle_deg);
    std::vector<double> off_m;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const DepthImage noisy = NoisyDepth(noise, wall, seed, {kCamera, nullptr, nullptr, nullptr});
      for (int v = 185; v < 215; ++v)  // farther from the middle rays meet the wall at more
        for (const int u : {199, 200}) off_m.push_back(noisy.At(u, v) - wall.At(u, v));
    }
    const double a = DegToRad(angle_deg), share = a / (M_PI_2 - a);
    const double expected_m = 0.001 * share * share / std::sqrt(2.0);
    EXPECT_NEAR(StatisticsOf(off_m).sigma, expected_m, 0.15 * expected_m) << angle_deg;
  }
  EXPECT_EQ(NoisyDepth(noise, Wall(2), 3).data, Wall(2).data) << "no camera, no angle";
}

TEST(SensorNoise, GrazingSurfacesAreLostFrom60DegreesOn) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_grazing_hole = 0.9; });
  const auto lost = [&](double angle_deg) {
    const DepthImage noisy =
        NoisyDepth(noise, TurnedWall(angle_deg), 3, {kCamera, nullptr, nullptr, nullptr});
    double sum = 0;
    for (int v = 190; v < 210; ++v) sum += (noisy.At(199, v) == 0) + (noisy.At(200, v) == 0);
    return sum / 40;
  };
  EXPECT_EQ(lost(40), 0);
  EXPECT_NEAR(lost(75), 0.45, 0.25);
}

TEST(SensorNoise, FlyingPixelsLieBetweenTheSidesOfAnEdge) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.depth_flying = 0.5; });
  const DepthImage depth_m = NoisyDepth(noise, Jump(), 3);
  int flying = 0, elsewhere = 0;
  for (int v = 0; v < kSize_px; ++v)
    for (int u = 0; u < kSize_px; ++u) {
      const bool is_between = depth_m.At(u, v) > 1 && depth_m.At(u, v) < 3;
      (u == kSize_px / 2 || u == kSize_px / 2 - 1 ? flying : elsewhere) += is_between ? 1 : 0;
    }
  EXPECT_NEAR(flying, kSize_px, 0.12 * kSize_px);  // half of two columns
  EXPECT_EQ(elsewhere, 0);
}

TEST(SensorNoise, DarkPixelsAndGlassAreLost) {
  RgbImage rgb(kSize_px, kSize_px, {200, 200, 200});
  InstanceImage instance(kSize_px, kSize_px, 0);
  for (int v = 0; v < kSize_px; ++v)
    for (int u = 0; u < kSize_px / 2; ++u) {
      rgb.At(u, v) = {0, 0, 0};
      instance.At(u, v) = 7;
    }
  const std::set<std::int32_t> glass = {7};
  const Scenery scenery = {kCamera, &rgb, &instance, &glass};
  for (const NoiseConfig& noise : {With([](NoiseConfig& c) { c.depth_dark_hole = 0.5; }),
                                   With([](NoiseConfig& c) { c.depth_glass_hole = 0.5; })}) {
    const DepthImage depth_m = NoisyDepth(noise, Wall(2), 3, scenery);
    EXPECT_NEAR(LostShare(depth_m), 0.25, 0.01);
    for (int v = 0; v < kSize_px; ++v) EXPECT_EQ(depth_m.At(kSize_px - 1, v), 2);
    EXPECT_EQ(LostShare(NoisyDepth(noise, Wall(2), 3)), 0) << "without colour and instances";
  }
  EXPECT_TRUE(IsGlass("window glass"));
  EXPECT_TRUE(IsGlass("mirror"));
  EXPECT_FALSE(IsGlass("window curtain"));
  EXPECT_FALSE(IsGlass("wall"));
}

TEST(SensorNoise, RollingExposureLeansWhatIsUpright) {
  const NoiseConfig noise = With([](NoiseConfig& c) { c.rolling_px = 10; });
  int farthest = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RgbImage line(64, 33);
    for (int v = 0; v < line.height; ++v) line.At(32, v) = {255, 255, 255};
    const RgbImage rolled = NoisyColour(noise, line, seed);
    const auto place = [&](int v) {
      int u = 0;
      while (u < 63 && rolled.At(u, v).r == 0) ++u;
      return u;
    };
    EXPECT_EQ(place(0), 32);
    EXPECT_NEAR(place(16) - 32, (place(32) - 32) / 2.0, 1);
    farthest = std::max(farthest, std::abs(place(32) - 32));
  }
  EXPECT_GE(farthest, 9);
  EXPECT_LE(farthest, 10);
}

TEST(SensorNoise, OffIsOff) {
  EXPECT_FALSE(SensorNoise(NoiseConfig(), 1).IsOn());
  EXPECT_FALSE(SensorNoise(NoiseOfProfile("none"), 1).IsOn());
  for (const char* profile : {"realsense", "kinect", "spot"}) {
    EXPECT_TRUE(SensorNoise(NoiseOfProfile(profile), 1).IsOn()) << profile;
  }
  EXPECT_EQ(NoisyDepth(NoiseConfig(), Jump(), 1).data, Jump().data);
  EXPECT_EQ(NoisyColour(NoiseConfig(), SmallFrame().rgb, 1).data, SmallFrame().rgb.data);
}

TEST(SensorNoise, TheSameSeedGivesTheSameAndAnotherEpisodeOther) {
  const auto play = [](std::uint64_t noise_seed, std::uint64_t episode) {
    NoiseConfig noise = NoiseOfProfile("spot");
    noise.drop = 0;
    noise.seed = noise_seed;
    SensorNoise one(noise, episode);
    Frame frame = SmallFrame();
    one.Disturb(frame, {}, {});
    one.Disturb(frame, {}, {});
    return std::make_tuple(frame.depth_m.data, frame.rgb.data, one.MoveFactor(),
                           Walk(one, 10).p_world.y());
  };
  EXPECT_EQ(play(1, 2), play(1, 2));
  EXPECT_NE(std::get<0>(play(1, 2)), std::get<0>(play(1, 3)));
  EXPECT_NE(std::get<2>(play(1, 2)), std::get<2>(play(2, 2)));
  EXPECT_NE(std::get<3>(play(1, 2)), std::get<3>(play(2, 2)));
}

}  // namespace
}  // namespace crossnav::sim
