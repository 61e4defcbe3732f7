// SPDX-License-Identifier: MIT
// A small map with features, built frame by frame from a wavy room, and comparisons of two maps.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/store/map_file.h"

namespace crossnav::store::testing {

inline constexpr int kDim = 48;

struct SmallWorld {
  geometry::VoxelMap map;
  memory::SemanticMemory memory;

  explicit SmallWorld(const geometry::MapConfig& config = {},
                      const memory::FusionConfig& fusion = {})
      : map(config), memory(fusion, config.voxel_m) {}

  /// Frame `i` of an endless walk; the same number gives the same frame.
  void AddFrame(int i) { AddFrameTo(i, map, memory); }

  static void AddFrameTo(int i, geometry::VoxelMap& map, memory::SemanticMemory& memory) {
    Rng rng(static_cast<std::uint64_t>(i) + 100);
    constexpr int kWidth = 40, kHeight = 32;
    const CameraIntrinsics camera = IntrinsicsFromHfov(kWidth, kHeight, 1.4);
    DepthImage depth(kWidth, kHeight);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        depth.At(u, v) =
            static_cast<float>(1.6 + 0.5 * std::sin(u / 6.0 + i) + (u / 9 + v / 8) % 2);
    const AgentPose agent{{0.3 * i, 0.1 * i, 0}, 0.7 * i, -0.3};
    const Pose T_world_camera = CameraPose(agent, 0.88);
    std::vector<float> data(static_cast<std::size_t>(4) * 5 * kDim);
    for (float& x : data) x = static_cast<float>(rng.Normal());
    const auto& pixels = map.Integrate(depth, camera, T_world_camera);
    memory.Fuse(pixels, depth, camera, T_world_camera, {4, 5, kDim, data});
    map.ObserveBody(agent.p_world, 0.88);
    map.UpdateStates();
    std::vector<geometry::VoxelKey> steps;
    for (std::size_t k = 0; k < pixels.size(); k += 50) steps.push_back(pixels[k].key);
    map.MarkStair(steps, i % 2 == 0 ? geometry::StairMark::kStair : geometry::StairMark::kFake);
    map.UpdateStates();
  }
};

inline std::map<geometry::VoxelKey, geometry::Voxel> VoxelsOf(const geometry::VoxelMap& map) {
  std::map<geometry::VoxelKey, geometry::Voxel> out;
  map.ForEach([&](const auto& key, const auto& voxel) { out.emplace(key, voxel); });
  return out;
}

/// Everything equal, byte for byte and in the same order.
inline void ExpectSame(const geometry::VoxelMap& map_a, const memory::SemanticMemory& a,
                       const geometry::VoxelMap& map_b, const memory::SemanticMemory& b) {
  EXPECT_TRUE(geometry::ExportBlocks(map_a) == geometry::ExportBlocks(map_b));
  EXPECT_TRUE(VoxelsOf(map_a) == VoxelsOf(map_b));
  ASSERT_EQ(a.Size(), b.Size());
  for (std::int64_t row = 0; row < a.Size(); ++row) {
    const memory::MemoryRow ra = a.RowAt(row), rb = b.RowAt(row);
    ASSERT_EQ(ra.key, rb.key);
    ASSERT_TRUE(ra == rb) << "row " << row;
    ASSERT_EQ(a.RowOf(ra.key), row);
    ASSERT_EQ(b.RowOf(ra.key), row);
  }
  EXPECT_EQ(a.Counters().compacted_rows, b.Counters().compacted_rows);
  EXPECT_EQ(a.Counters().dropped_rows, b.Counters().dropped_rows);
}

inline LoadOptions WithMap(const geometry::MapConfig& config) {
  LoadOptions options;
  options.map = config;
  return options;
}
inline LoadOptions FromEncoder(const std::string& name, std::uint64_t hash = 0) {
  LoadOptions options;
  options.encoder_name = name;
  options.encoder_hash = hash;
  return options;
}
inline LoadOptions SkipDamaged() {
  LoadOptions options;
  options.skip_damaged = true;
  return options;
}

/// A file name of this test alone, removed before and after.
class TempFile {
 public:
  explicit TempFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("crossnav_" + std::to_string(::getpid()) + "_" + name)) {
    Remove();
  }
  ~TempFile() { Remove(); }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void Remove() const {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    std::filesystem::remove(path_.string() + "-journal", ignored);
  }
  std::string Read() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void Write(const std::string& bytes) const {
    std::ofstream out(path_, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace crossnav::store::testing
