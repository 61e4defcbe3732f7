// SPDX-License-Identifier: MIT
// Golden vectors for support classification, and a small case that needs no file.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/places.h"
#include "tests/geometry/map_of_evidence.h"

namespace crossnav::geometry::testing {
namespace {

StairMark MarkOf(const std::string& name) {
  if (name == "STAIR") return StairMark::kStair;
  if (name == "STAIR_EXPANDED") return StairMark::kExpanded;
  return name == "FAKE_STAIR" ? StairMark::kFake : StairMark::kNone;
}

TEST(SupportVectorsTest, AirStatesEqualTheGoldenVectors) {
  std::ifstream in(test::SharedPath("vectors/support.json"));
  if (!in) GTEST_SKIP() << "no shared/vectors/support.json";
  const nlohmann::json golden = nlohmann::json::parse(in);
  MapConfig config;
  config.support_depth_m = config.voxel_m * golden["search_voxels"].get<int>();
  std::map<VoxelKey, StairMark> surface;
  KeySet free;
  for (const auto& s : golden["surface"]) surface[{s[0], s[1], s[2]}] = MarkOf(s[3]);
  for (const auto& f : golden["free"]) free.insert({f[0], f[1], f[2]});
  const VoxelMap map = MapOfEvidence(surface, free, config);
  ASSERT_GT(golden["air"].size(), 100U);
  for (const auto& air : golden["air"])
    EXPECT_EQ(FactsOf(map.StateAt({air[0], air[1], air[2]})).name, air[3].get<std::string>());
}

TEST(SupportVectorsTest, TheNearestSurfaceWithinFourVoxelsDecides) {
  const std::map<VoxelKey, StairMark> surface = {
      {{0, 0, 0}, StairMark::kNone}, {{0, 0, 2}, StairMark::kStair}, {{1, 0, 0}, StairMark::kFake}};
  KeySet free;
  for (int z = 1; z <= 8; ++z)
    for (int x = 0; x <= 2; ++x) free.insert({x, 0, z});
  const VoxelMap map = MapOfEvidence(surface, free);
  EXPECT_EQ(map.StateAt({0, 0, 1}), VoxelState::kTraversable);
  EXPECT_EQ(map.StateAt({0, 0, 2}), VoxelState::kStair);
  EXPECT_EQ(map.StateAt({0, 0, 6}), VoxelState::kTraversableStair);
  EXPECT_EQ(map.StateAt({0, 0, 7}), VoxelState::kTraversableFake);
  EXPECT_EQ(map.StateAt({1, 0, 4}), VoxelState::kTraversable);
  EXPECT_EQ(map.StateAt({1, 0, 5}), VoxelState::kTraversableFake);
  EXPECT_EQ(map.StateAt({2, 0, 1}), VoxelState::kTraversableFake);
  EXPECT_EQ(map.StateAt({3, 0, 1}), VoxelState::kUnknown);
}

}  // namespace
}  // namespace crossnav::geometry::testing
