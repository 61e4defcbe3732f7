// SPDX-License-Identifier: MIT
#include "crossnav/policy/clusters.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using Clusters = std::vector<std::vector<VoxelKey>>;

/// All pairs, union-find: the oracle.
Clusters ByUnionFind(const std::set<VoxelKey>& unique, int reach) {
  const std::vector<VoxelKey> keys(unique.begin(), unique.end());
  std::vector<std::size_t> parent(keys.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const VoxelKey d = keys[i] - keys[j];
      if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > reach) continue;
      const std::size_t a = root(i), b = root(j);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::map<std::size_t, std::vector<VoxelKey>> parts;  // by smallest member, members ascending
  for (std::size_t i = 0; i < keys.size(); ++i) parts[root(i)].push_back(keys[i]);
  Clusters clusters;
  for (auto& [first, members] : parts) clusters.push_back(std::move(members));
  return clusters;
}

TEST(ConnectedClusters, EqualUnionFindOverAllPairs) {
  Rng rng(1);
  for (int trial = 0; trial < 60; ++trial) {
    const int reach = rng.Int(1, 3), side = rng.Int(2, 12);
    std::vector<VoxelKey> keys;
    for (int i = rng.Int(0, 150); i > 0; --i)
      keys.push_back({rng.Int(-side, side), rng.Int(-side, side), rng.Int(-side, side)});
    const std::set<VoxelKey> unique(keys.begin(), keys.end());
    EXPECT_EQ(ConnectedClusters(keys, reach), ByUnionFind(unique, reach)) << "trial " << trial;
  }
}

TEST(ConnectedClusters, TheOrderOfTheInputDoesNotMatter) {
  Rng rng(2);
  std::vector<VoxelKey> keys;
  for (int i = 0; i < 80; ++i) keys.push_back({rng.Int(-5, 5), rng.Int(-5, 5), rng.Int(-5, 5)});
  const auto first = ConnectedClusters(keys);
  rng.Shuffle(keys);
  EXPECT_EQ(ConnectedClusters(keys), first);
}

TEST(ConnectedClusters, OfNothingAreNone) {
  EXPECT_TRUE(ConnectedClusters({}).empty());
}

TEST(CentroidOf, IsTheMeanOfTheCentres) {
  EXPECT_TRUE(CentroidOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 3}}, 0.1).isApprox(Vector3d(.15, .05, .15)));
  EXPECT_EQ(CentroidOf({}, 0.1), Vector3d::Zero());
}

}  // namespace
}  // namespace crossnav::policy
