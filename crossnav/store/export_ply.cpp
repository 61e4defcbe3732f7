// SPDX-License-Identifier: MIT
#include "crossnav/store/export_ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "crossnav/core/check.h"
#include "crossnav/core/write_file.h"

namespace crossnav::store {
namespace {

constexpr std::array<Rgb8, geometry::kVoxelStateCount> kStateColours = {{
    {0, 0, 0},        // UNKNOWN
    {140, 140, 140},  // OCCUPIED
    {120, 200, 120},  // TRAVERSABLE
    {80, 160, 220},   // TRAVERSABLE_STAIR
    {220, 200, 140},  // TRAVERSABLE_FAKE
    {40, 80, 200},    // STAIR
    {110, 90, 210},   // STAIR_EXPANDED
    {210, 90, 60},    // FAKE_STAIR
}};

// Dark blue, teal, yellow: monotone in lightness, so that it is legible in grey.
Rgb8 Ramp(double t) {
  constexpr std::array<std::array<double, 3>, 3> kStops = {
      {{40, 20, 90}, {30, 140, 140}, {250, 230, 60}}};
  const double x = std::clamp(t, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), kStops.size() - 2);
  const double f = x - static_cast<double>(i);
  const auto mix = [&](int k) {
    return static_cast<std::uint8_t>(
        std::lround(kStops[i][k] + f * (kStops[i + 1][k] - kStops[i][k])));
  };
  return {mix(0), mix(1), mix(2)};
}

template <class T>
void Put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

Rgb8 ColourOf(geometry::VoxelState state) {
  return kStateColours[static_cast<std::size_t>(state)];
}

std::vector<PlyPoint> StatePoints(const geometry::VoxelMap& map, bool surfaces_only) {
  std::vector<std::pair<geometry::VoxelKey, geometry::VoxelState>> voxels;
  map.ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    if (!surfaces_only || geometry::IsSurface(voxel.state)) voxels.emplace_back(key, voxel.state);
  });
  std::sort(voxels.begin(), voxels.end());
  std::vector<PlyPoint> points;
  points.reserve(voxels.size());
  for (const auto& [key, state] : voxels)
    points.push_back({geometry::CenterOf(key, map.config().voxel_m).cast<float>(), ColourOf(state),
                      static_cast<float>(state)});
  return points;
}

std::vector<PlyPoint> FieldPoints(const memory::SemanticMemory& memory,
                                  std::span<const float> field) {
  CROSSNAV_CHECK(static_cast<std::int64_t>(field.size()) == memory.Size(), "one value per row");
  std::vector<PlyPoint> points;
  if (field.empty()) return points;
  const auto [low, high] = std::minmax_element(field.begin(), field.end());
  const double range = std::max(static_cast<double>(*high) - *low, 1e-9);
  for (std::size_t row = 0; row < field.size(); ++row)
    points.push_back({geometry::CenterOf(memory.Keys()[row], memory.VoxelSize()).cast<float>(),
                      Ramp((field[row] - *low) / range), field[row]});
  return points;
}

Result<void> WritePly(const std::filesystem::path& path, std::span<const PlyPoint> points) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment voxel centres, world frame, metres\n"
      "element vertex " +
      std::to_string(points.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nproperty float value\nend_header\n";
  for (const PlyPoint& p : points) {
    for (int axis = 0; axis < 3; ++axis) Put(bytes, p.p_world[axis]);
    Put(bytes, p.colour.r);
    Put(bytes, p.colour.g);
    Put(bytes, p.colour.b);
    Put(bytes, p.value);
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace crossnav::store
