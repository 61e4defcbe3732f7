// SPDX-License-Identifier: MIT
// The five real depth frames of the shared data (rgbd/), read for tests and benchmarks.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "tests/geometry/random_frames.h"

namespace crossnav::geometry::testing {

/// A 16-bit binary PGM in millimetres, every `step`-th pixel of it; empty if it cannot be read.
inline DepthImage ReadDepthPgm(const std::string& path, int step) {
  std::ifstream in(path, std::ios::binary);
  std::string magic;
  int width = 0, height = 0, most = 0;
  in >> magic >> width >> height >> most;
  in.get();
  if (!in || magic != "P5" || most <= 255 || width <= 0 || height <= 0) return {};
  std::vector<unsigned char> bytes(static_cast<std::size_t>(width) * height * 2);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) return {};
  DepthImage depth(width / step, height / step);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      const std::size_t i = 2 * (static_cast<std::size_t>(v) * step * width + u * step);
      depth.At(u, v) = static_cast<float>(bytes[i] * 256 + bytes[i + 1]) * 0.001F;
    }
  return depth;
}

/// The frames under `shared`; empty where they are absent.
inline std::vector<TestFrame> ReadRgbdFrames(const std::string& shared, int step) {
  std::vector<TestFrame> frames;
  std::ifstream poses(shared + "/data/rgbd/pose.txt");
  double p[7];
  for (int i = 1; poses >> p[0] >> p[1] >> p[2] >> p[3] >> p[4] >> p[5] >> p[6]; ++i) {
    TestFrame frame;
    frame.depth_m = ReadDepthPgm(shared + "/data/rgbd/depth/" + std::to_string(i) + ".pgm", step);
    if (frame.depth_m.empty()) return {};
    frame.camera = {frame.depth_m.width, frame.depth_m.height, 518.0 / step,
                    519.0 / step,        325.5 / step,         253.5 / step};
    frame.T_world_camera = Pose::Identity();
    frame.T_world_camera.linear() =
        Eigen::Quaterniond(p[6], p[3], p[4], p[5]).normalized().toRotationMatrix();
    frame.T_world_camera.translation() = Vector3d(p[0], p[1], p[2]);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace crossnav::geometry::testing
