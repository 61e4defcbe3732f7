// SPDX-License-Identifier: MIT
#include "crossnav/policy/clusters.h"

#include <algorithm>

namespace crossnav::policy {

using geometry::VoxelKey;

std::vector<std::vector<VoxelKey>> ConnectedClusters(std::vector<VoxelKey> keys, int reach_vox) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<bool> is_taken(keys.size(), false);
  std::vector<std::vector<VoxelKey>> clusters;
  std::vector<std::size_t> stack;
  for (std::size_t seed = 0; seed < keys.size(); ++seed) {
    if (is_taken[seed]) continue;
    std::vector<VoxelKey> cluster;
    is_taken[seed] = true;
    stack.push_back(seed);
    while (!stack.empty()) {
      const VoxelKey key = keys[stack.back()];
      stack.pop_back();
      cluster.push_back(key);
      for (int dx = -reach_vox; dx <= reach_vox; ++dx)
        for (int dy = -reach_vox; dy <= reach_vox; ++dy) {
          // Keys are sorted x, y, z: one column's neighbours lie side by side.
          const VoxelKey lowest{key.x + dx, key.y + dy, key.z - reach_vox};
          auto it = std::lower_bound(keys.begin(), keys.end(), lowest);
          for (; it != keys.end() && it->x == lowest.x && it->y == lowest.y &&
                 it->z <= key.z + reach_vox;
               ++it) {
            const auto index = static_cast<std::size_t>(it - keys.begin());
            if (is_taken[index]) continue;
            is_taken[index] = true;
            stack.push_back(index);
          }
        }
    }
    std::sort(cluster.begin(), cluster.end());
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

Vector3d CentroidOf(const std::vector<VoxelKey>& keys, double voxel_m) {
  Vector3d sum = Vector3d::Zero();
  for (const VoxelKey& key : keys) sum += geometry::CenterOf(key, voxel_m);
  return keys.empty() ? sum : Vector3d(sum / static_cast<double>(keys.size()));
}

}  // namespace crossnav::policy
