// SPDX-License-Identifier: MIT
#include "crossnav/store/export_ply.h"

#include <gtest/gtest.h>

#include <cstring>

#include "store/small_world.h"

namespace crossnav::store {
namespace {

using testing::SmallWorld;
using testing::TempFile;

TEST(ExportPlyTest, FileHoldsEveryPointAsTheHeaderSays) {
  const TempFile file("points.ply");
  const std::vector<PlyPoint> points = {{{1, 2, 3}, {10, 20, 30}, 0.5f},
                                        {{-1, 0, 4}, {1, 2, 3}, 7}};
  ASSERT_TRUE(WritePly(file.path(), points));
  const std::string bytes = file.Read();
  EXPECT_EQ(bytes.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  EXPECT_NE(bytes.find("element vertex 2\n"), std::string::npos);
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - body, 2u * 19);
  float x = 0, value = 0;
  std::memcpy(&x, &bytes[body + 19], 4);
  std::memcpy(&value, &bytes[body + 19 + 15], 4);
  EXPECT_EQ(x, -1);
  EXPECT_EQ(value, 7);
  EXPECT_EQ(static_cast<unsigned char>(bytes[body + 13]), 20);
}

TEST(ExportPlyTest, StatesHaveTheirColoursAndAirIsLeftOutOnRequest) {
  SmallWorld world;
  world.AddFrame(0);
  const auto all = StatePoints(world.map, false), surfaces = StatePoints(world.map, true);
  EXPECT_EQ(static_cast<std::int64_t>(all.size()), world.map.Stats().known);
  EXPECT_LT(surfaces.size(), all.size());
  EXPECT_GT(surfaces.size(), 0u);
  for (const PlyPoint& p : surfaces) {
    const auto state =
        world.map.StateAt(geometry::KeyOf(p.p_world.cast<double>(), world.map.config().voxel_m));
    EXPECT_TRUE(geometry::IsSurface(state));
    EXPECT_EQ(p.colour, ColourOf(state));
  }
}

TEST(ExportPlyTest, HighestValueIsBrightest) {
  SmallWorld world;
  world.AddFrame(0);
  std::vector<float> field(world.memory.Size(), 0.1f);
  field[3] = 0.9f;
  const auto points = FieldPoints(world.memory, field);
  ASSERT_EQ(points.size(), field.size());
  EXPECT_GT(points[3].colour.r, points[4].colour.r);
  EXPECT_EQ(points[3].value, 0.9f);
}

TEST(ExportPlyTest, FolderThatDoesNotExistIsAnError) {
  EXPECT_FALSE(WritePly("/nowhere/at/all.ply", {}));
}

}  // namespace
}  // namespace crossnav::store
