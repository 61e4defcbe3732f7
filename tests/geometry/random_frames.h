// SPDX-License-Identifier: MIT
// Random depth frames: patches of smooth depth, speckle, holes and far readings, from any pose.
#pragma once

#include <limits>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/rng.h"

namespace crossnav::geometry::testing {

struct TestFrame {
  DepthImage depth_m;
  CameraIntrinsics camera;
  Pose T_world_camera;
};

inline Pose RandomPose(Rng& rng, double extent_m) {
  Eigen::Quaterniond q(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
  Pose T = Pose::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  for (int a = 0; a < 3; ++a) T.translation()[a] = rng.Uniform(-extent_m, extent_m);
  return T;
}

inline DepthImage RandomDepth(Rng& rng, int width, int height) {
  DepthImage depth(width, height);
  const double speckle = rng.Chance(0.5) ? 0.0 : 0.1;
  const double base = rng.Uniform(0.3, 4), slope_u = rng.Uniform(-2, 2) / width,
               slope_v = rng.Uniform(-2, 2) / height;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      double z = base + slope_u * u + slope_v * v + (u / 9 % 3 == 1 && v / 7 % 2 == 1 ? 0.6 : 0);
      if (rng.Chance(speckle)) z = rng.Uniform(0.05, 12);
      if (rng.Chance(0.02)) z = std::numeric_limits<float>::quiet_NaN();
      if (rng.Chance(0.02)) z = 0;
      depth.At(u, v) = static_cast<float>(z);
    }
  return depth;
}

inline TestFrame RandomFrame(Rng& rng, int width = 40, int height = 30, double extent_m = 2) {
  TestFrame frame{RandomDepth(rng, width, height),
                  IntrinsicsFromHfov(width, height, rng.Uniform(0.6, 2.0)),
                  RandomPose(rng, extent_m)};
  return frame;
}

}  // namespace crossnav::geometry::testing
