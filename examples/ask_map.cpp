// SPDX-License-Identifier: MIT
// Queries a saved map: where is the object of this vector? The vector is a text's, from your
// encoder (a NumPy file of one float32 row), or the map's own at a point: "where is more of this?".
//   ask_map MAP TEXT.npy
//   ask_map MAP X Y Z           metres, world frame
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "crossnav/core/npy_file.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/store/map_file.h"

namespace {

/// Feature of the row nearest to a point.
std::vector<float> FeatureNear(const crossnav::memory::SemanticMemory& memory,
                               const crossnav::Vector3d& p_world) {
  std::int64_t nearest = 0;
  double nearest_m = 1e30;
  for (std::int64_t row = 0; row < memory.Size(); ++row) {
    const auto& key = memory.Keys()[static_cast<std::size_t>(row)];
    const crossnav::Vector3d p =
        crossnav::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5) * memory.VoxelSize();
    if ((p - p_world).norm() < nearest_m) {
      nearest_m = (p - p_world).norm();
      nearest = row;
    }
  }
  return memory.FeatureAt(nearest);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 5) {
    std::fprintf(stderr, "ask_map MAP TEXT.npy, or ask_map MAP X Y Z\n");
    return 1;
  }
  const auto loaded = crossnav::store::LoadMemory(argv[1]);
  if (!loaded) {
    std::fprintf(stderr, "%s\n", loaded.error().Message().c_str());
    return 1;
  }
  std::printf("%lld feature rows of '%s', %zu flights of stairs\n",
              static_cast<long long>(loaded->memory.Size()), loaded->header.encoder_name.c_str(),
              loaded->flights.size());
  if (loaded->memory.Size() == 0) return 0;

  std::vector<float> vector;
  if (argc == 3) {
    auto rows = crossnav::ReadNpyRows(argv[2], 1);
    if (!rows || rows->front().size() != static_cast<std::size_t>(loaded->memory.Dim())) {
      std::fprintf(stderr, "%s: not one row of %d numbers\n", argv[2], loaded->memory.Dim());
      return 1;
    }
    vector = rows->front();
  } else {
    vector =
        FeatureNear(loaded->memory, {std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])});
  }
  for (const auto& place : crossnav::memory::Query(loaded->memory, vector, {})) {
    const auto& p = place.p_center_world;
    const auto& from = place.p_best_view_world;
    std::printf("at %.2f %.2f %.2f, similarity %.2f, best seen from %.2f %.2f %.2f\n", p.x(), p.y(),
                p.z(), place.similarity, from.x(), from.y(), from.z());
  }
  return 0;
}
