// SPDX-License-Identifier: MIT
// Frames for the tests of fusion: a wavy surface with holes and random features.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "crossnav/core/rng.h"
#include "memory/literal_memory.h"

namespace crossnav::memory::testing {

struct TestFrame {
  DepthImage depth;
  CameraIntrinsics camera;
  Pose T_world_camera = Pose::Identity();
  FeatureGridView grid;
  std::vector<float> data;
  std::vector<PixelVoxel> pixels;
};

// A wavy surface with holes, seen from a random pose; random features.
inline TestFrame MakeFrame(int width, int height, int rows, int cols, int dim, Rng& rng) {
  TestFrame f;
  f.camera = IntrinsicsFromHfov(width, height, 1.4);
  f.depth = DepthImage(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      f.depth.At(u, v) = static_cast<float>(1.4 + 0.8 * std::sin(u / 5.0) * std::cos(v / 4.0) +
                                            1.5 * ((u / 7 + v / 6) % 2));
      if (rng.Chance(0.06)) f.depth.At(u, v) = 0;
    }
  f.depth.At(0, 0) = std::numeric_limits<float>::quiet_NaN();
  f.T_world_camera = CameraPose(
      {{rng.Uniform(-1, 1), rng.Uniform(-1, 1), 0}, rng.Uniform(-3, 3), rng.Uniform(-0.5, 0.5)},
      0.9);
  f.data.resize(static_cast<std::size_t>(rows) * cols * dim);
  for (float& x : f.data) x = static_cast<float>(rng.Normal());
  f.grid = {rows, cols, dim, f.data};
  f.pixels = EndVoxels(f.depth, f.camera, f.T_world_camera, 0.1);
  return f;
}

inline void FuseFrame(SemanticMemory& memory, const TestFrame& f) {
  memory.Fuse(f.pixels, f.depth, f.camera, f.T_world_camera, f.grid);
}

inline FusionConfig FloatRows() {
  FusionConfig config;
  config.storage = "float";
  return config;
}

}  // namespace crossnav::memory::testing
