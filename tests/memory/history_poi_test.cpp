// SPDX-License-Identifier: MIT
#include "crossnav/memory/history_poi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "crossnav/core/rng.h"
#include "crossnav/memory/row_kernels.h"

namespace crossnav::memory {
namespace {

constexpr int kDim = 64;

std::vector<float> RandomVector(Rng& rng, double norm) {
  std::vector<float> v(kDim);
  for (float& x : v) x = static_cast<float>(rng.Normal() * norm / std::sqrt(kDim));
  return v;
}

// A memory written by hand: blobs of voxels with a feature, on a noisy floor.
struct World {
  SemanticMemory memory;
  Rng rng{11};
  std::vector<float> common = RandomVector(rng, 1.0);

  void Put(const VoxelKey& key, const std::vector<float>& direction, double share,
           const Vector3f& view = Vector3f::Zero()) {
    std::vector<float> f = RandomVector(rng, 0.2);
    for (int i = 0; i < kDim; ++i) f[i] += static_cast<float>(common[i] + share * direction[i]);
    MemoryRow row{key, 1.0f, 1.0f, view, std::vector<std::uint16_t>(kDim)};
    ToHalf(f, row.half.data());
    if (!memory.RowOf(key)) memory.AppendRow(row);
  }
  void Blob(const VoxelKey& lo, int side, const std::vector<float>& direction, double share,
            const Vector3f& view = Vector3f::Zero()) {
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y)
        for (int z = 0; z < side; ++z) Put(lo + VoxelKey{x, y, z}, direction, share, view);
  }
  void Floor(int side) {
    const std::vector<float> nothing(kDim, 0.0f);
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y) Put({x, y, 0}, nothing, 0);
  }
};

TEST(HistoryPoiTest, FindsThePlacesThatShowTheGoalBestFirst) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  w.Blob({10, 10, 5}, 4, text, 1.5);
  w.Blob({40, 40, 5}, 4, text, 3.0);
  w.Floor(60);
  const auto clusters = Query(w.memory, text, {});
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_NEAR(clusters[0].p_center_world.x(), 4.2, 0.1);
  EXPECT_NEAR(clusters[1].p_center_world.x(), 1.2, 0.1);
  EXPECT_GT(clusters[0].score, clusters[1].score);
  EXPECT_EQ(clusters[0].voxels.size(), 64u);
  EXPECT_NEAR(clusters[0].box.min.x(), 4.0, 1e-9);
  EXPECT_NEAR(clusters[0].box.max.z(), 0.9, 1e-9);
}

TEST(HistoryPoiTest, EqualsBruteForce) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  for (int i = 0; i < 300; ++i)
    w.Put({w.rng.Int(-9, 9), w.rng.Int(-9, 9), w.rng.Int(3, 8)}, text, 3.0);
  w.Floor(40);
  QueryConfig config;
  config.top_k = 1000;
  config.min_voxels = 1;
  config.cluster_radius_vox = 1.5;
  const auto clusters = Query(w.memory, text, config);
  // Every two members within the radius share a cluster; members of different clusters are apart;
  // every cluster is connected.
  std::set<VoxelKey> seen;
  for (const MemoryCluster& a : clusters) {
    for (const VoxelKey& key : a.voxels) EXPECT_TRUE(seen.insert(key).second);
    std::set<VoxelKey> reached = {a.voxels[0]};
    for (bool grew = true; grew;) {
      grew = false;
      for (const VoxelKey& k : a.voxels)
        if (!reached.count(k) &&
            std::any_of(reached.begin(), reached.end(),
                        [&](const VoxelKey& r) { return geometry::VoxelDistance(k, r) <= 1.5; }))
          grew = reached.insert(k).second;
    }
    EXPECT_EQ(reached.size(), a.voxels.size());
    for (const MemoryCluster& b : clusters) {
      if (&a == &b) continue;
      for (const VoxelKey& ka : a.voxels)
        for (const VoxelKey& kb : b.voxels) EXPECT_GT(geometry::VoxelDistance(ka, kb), 1.5);
    }
  }
  EXPECT_GT(clusters.size(), 3u);
}

TEST(HistoryPoiTest, WithoutOutstandingVoxelsTheResultIsEmpty) {
  World w;
  w.Floor(40);
  EXPECT_TRUE(Query(w.memory, RandomVector(w.rng, 1.0), {}).empty());
  EXPECT_TRUE(Query(SemanticMemory(), RandomVector(w.rng, 1.0), {}).empty());
}

TEST(HistoryPoiTest, SmallClustersAreDroppedAndTopKHolds) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  for (int i = 0; i < 6; ++i) w.Blob({10 * i, 0, 5}, 2, text, 3.0);
  w.Put({5, 20, 5}, text, 3.0);
  w.Floor(60);
  QueryConfig config;
  EXPECT_EQ(Query(w.memory, text, config).size(), 4u);
  config.top_k = 100;
  EXPECT_EQ(Query(w.memory, text, config).size(), 6u);
  config.min_voxels = 1;
  EXPECT_EQ(Query(w.memory, text, config).size(), 7u);
}

TEST(HistoryPoiTest, BestViewIsTheCameraThatSawMostOfThePlace) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  w.Blob({10, 10, 5}, 2, text, 3.0, {9, 9, 9});
  w.Blob({10, 10, 7}, 3, text, 3.0, {1, 2, 3});
  w.Floor(50);
  const auto clusters = Query(w.memory, text, {});
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].p_best_view_world, Vector3d(1, 2, 3));
  // The best view's direction puts the centre in the middle of the image.
  const MemoryCluster& c = clusters[0];
  const Pose T_world_camera =
      CameraPose({c.p_best_view_world, c.best_view_yaw_rad, c.best_view_pitch_rad}, 0);
  const Vector3d p_camera = T_world_camera.inverse() * c.p_center_world;
  EXPECT_NEAR(p_camera.x(), 0, 1e-9);
  EXPECT_NEAR(p_camera.y(), 0, 1e-9);
  EXPECT_GT(p_camera.z(), 0);
}

TEST(HistoryPoiTest, ContrastiveRelevancySuppressesBackground) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  std::vector<float> other = RandomVector(w.rng, 1.0);
  std::vector<float> mixed(kDim);
  for (int i = 0; i < kDim; ++i) mixed[i] = 0.6f * text[i] + 1.5f * other[i];
  w.Blob({10, 10, 5}, 4, text, 2.0);
  w.Blob({30, 30, 5}, 6, mixed, 2.0);
  w.Floor(60);
  QueryConfig config;
  config.min_peak_share = 0;
  const std::vector<std::vector<float>> background = {other};
  EXPECT_EQ(Query(w.memory, text, config, background).size(), 2u);
  config.relevancy = "contrastive";
  const auto clusters = Query(w.memory, text, config, background);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_NEAR(clusters[0].p_center_world.x(), 1.2, 0.1);
  for (float r : RelevancyField(w.memory, text, config, background)) {
    EXPECT_GE(r, 0.0f);
    EXPECT_LE(r, 1.0f);
  }
}

TEST(HistoryPoiTest, QueryDoesNotChangeTheMemory) {
  World w;
  const std::vector<float> text = RandomVector(w.rng, 1.0);
  w.Blob({10, 10, 5}, 4, text, 2.0);
  w.Floor(30);
  std::vector<MemoryRow> before;
  for (std::int64_t i = 0; i < w.memory.Size(); ++i) before.push_back(w.memory.RowAt(i));
  Query(w.memory, text, {});
  for (std::int64_t i = 0; i < w.memory.Size(); ++i) {
    const MemoryRow after = w.memory.RowAt(i);
    EXPECT_EQ(after.half, before[i].half);
    EXPECT_EQ(after.weight, before[i].weight);
  }
}

}  // namespace
}  // namespace crossnav::memory
