// SPDX-License-Identifier: MIT
#include "crossnav/trace/voxel_codec.h"

#include <gtest/gtest.h>

#include <map>

#include "crossnav/core/rng.h"

namespace crossnav::trace {
namespace {

using geometry::StateChange;
using geometry::Voxel;
using geometry::VoxelKey;
using geometry::VoxelState;

std::vector<StateChange> RandomChanges(std::uint64_t seed, int reach, int count) {
  Rng rng(seed);
  std::map<VoxelKey, Voxel> unique;
  for (int i = 0; i < count; ++i) {
    const VoxelKey key{rng.Int(-reach, reach), rng.Int(-reach, reach), rng.Int(-reach, reach)};
    unique[key] = {static_cast<VoxelState>(rng.Below(3)), rng.Chance(0.3)};
  }
  std::vector<StateChange> changes;
  for (const auto& [key, voxel] : unique) changes.push_back({key, voxel});
  return changes;
}

void ExpectSame(const std::vector<StateChange>& a, const std::vector<StateChange>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].key, b[i].key);
    EXPECT_EQ(a[i].voxel.state, b[i].voxel.state);
    EXPECT_EQ(a[i].voxel.is_inflated, b[i].voxel.is_inflated);
  }
}

TEST(VoxelCodec, BringsRandomChangesBack) {
  for (const int reach : {3, 40, 1000000000}) {
    const auto changes = RandomChanges(static_cast<std::uint64_t>(reach), reach, 400);
    const auto back = DecodeVoxelRuns(EncodeVoxelRuns(changes));
    ASSERT_TRUE(back) << back.error().Message();
    ExpectSame(changes, *back);
  }
}

TEST(VoxelCodec, NeedsFiveBytesForAColumn) {
  std::vector<StateChange> wall;
  for (int z = 0; z < 26; ++z) wall.push_back({{-5, 7, z}, {VoxelState::kOccupied, false}});
  EXPECT_EQ(EncodeVoxelRuns(wall).size(), 5U);
}

TEST(VoxelCodec, HasTheBytesOfItsDocument) {
  const std::vector<StateChange> changes = {{{1, -1, 2}, {VoxelState::kOccupied, false}},
                                            {{1, -1, 3}, {VoxelState::kOccupied, false}},
                                            {{1, 0, 0}, {VoxelState::kTraversable, true}}};
  EXPECT_EQ(EncodeVoxelRuns(changes), std::string("\x02\x01\x04\x02\x01\x00\x02\x03\x01\x0A", 10));
}

TEST(VoxelCodec, OfNothingIsEmpty) {
  EXPECT_EQ(EncodeVoxelRuns({}), "");
  const auto back = DecodeVoxelRuns("");
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->empty());
}

TEST(VoxelCodec, RefusesARunThatIsCutShort) {
  const std::string runs = EncodeVoxelRuns(RandomChanges(1, 2000, 1));
  for (std::size_t n = 1; n < runs.size(); ++n) {
    EXPECT_FALSE(DecodeVoxelRuns(std::string_view(runs).substr(0, n)));
  }
}

TEST(VoxelCodec, RefusesLengthsAndKeysOutOfRange) {
  const std::string endless("\x00\x00\x00\xFF\xFF\xFF\xFF\x0F\x01", 9);
  EXPECT_FALSE(DecodeVoxelRuns(endless));
  const std::string empty_run("\x00\x00\x00\x00\x01", 5);
  EXPECT_FALSE(DecodeVoxelRuns(empty_run));
  const std::string no_state("\x00\x00\x00\x01\x10", 5);
  EXPECT_FALSE(DecodeVoxelRuns(no_state));
  const std::string far("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01\x00\x00\x01\x01", 14);
  EXPECT_FALSE(DecodeVoxelRuns(far));
}

TEST(VoxelCodec, SurvivesRandomBytes) {
  Rng rng(3);
  for (int i = 0; i < 3000; ++i) {
    std::string bytes;
    for (int k = rng.Int(0, 40); k > 0; --k) bytes += static_cast<char>(rng.Below(256));
    const auto read = DecodeVoxelRuns(bytes, 1000);
    if (read) {
      EXPECT_LE(read->size(), 1000U);
    }
  }
}

}  // namespace
}  // namespace crossnav::trace
