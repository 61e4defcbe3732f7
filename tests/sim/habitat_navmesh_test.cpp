// SPDX-License-Identifier: MIT
// The bytes are read as habitat-sim reads them.
#include "crossnav/sim/navmesh/habitat_navmesh.h"

#include <gtest/gtest.h>
#include <recastnavigation/DetourAlloc.h>
#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshQuery.h>

#include <cstring>

#include "crossnav/core/rng.h"
#include "sim/micro_scene.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::sim::test {
namespace {

using crossnav::test::TempFolder;
using crossnav::test::WriteText;

template <class T>
T Take(const std::string& bytes, std::size_t& at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  at += sizeof(value);
  return value;
}

TEST(HabitatNavMesh, IsReadAsByHabitatAndInItsFrame) {
  Scene scene;
  // A floor of 12 m by 4 m, so that there are two tiles; x from 0 to 12, y from 0 to 4.
  scene.mesh.vertices = {{0, 0, 1}, {12, 0, 1}, {12, 4, 1}, {0, 4, 1}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  UpdateDerived(scene);
  const auto bytes = EncodeHabitatNavMesh(scene, {});
  ASSERT_TRUE(bytes.has_value()) << bytes.error().Message();
  std::size_t at = 0;
  EXPECT_EQ(bytes->substr(0, 4), "TESM");
  Take<std::int32_t>(*bytes, at);
  EXPECT_EQ(Take<std::int32_t>(*bytes, at), 1);
  const auto tiles = Take<std::int32_t>(*bytes, at);
  EXPECT_EQ(tiles, 2);
  const auto params = Take<dtNavMeshParams>(*bytes, at);
  EXPECT_EQ(params.maxTiles, tiles);
  dtNavMesh* mesh = dtAllocNavMesh();
  ASSERT_TRUE(dtStatusSucceed(mesh->init(&params)));
  for (int i = 0; i < tiles; ++i) {
    const auto reference = Take<dtTileRef>(*bytes, at);
    const auto size = Take<std::int32_t>(*bytes, at);
    auto* data =
        static_cast<unsigned char*>(dtAlloc(static_cast<std::size_t>(size), DT_ALLOC_PERM));
    std::memcpy(data, bytes->data() + at, static_cast<std::size_t>(size));
    at += static_cast<std::size_t>(size);
    ASSERT_TRUE(dtStatusSucceed(mesh->addTile(data, size, DT_TILE_FREE_DATA, reference, nullptr)));
    EXPECT_NE(mesh->getTileByRef(reference), nullptr);
  }
  EXPECT_EQ(at, bytes->size());
  dtNavMeshQuery* query = dtAllocNavMeshQuery();
  ASSERT_TRUE(dtStatusSucceed(query->init(mesh, 2048)));
  dtQueryFilter filter;
  filter.setIncludeFlags(1);
  const float half[3] = {0.05F, 0.3F, 0.05F};
  const auto is_ground = [&](float x, float y, float z) {
    const float p[3] = {x, y, z};
    dtPolyRef found = 0;
    float q[3];
    query->findNearestPoly(p, half, &filter, &found, q);
    return found != 0;
  };
  EXPECT_TRUE(is_ground(-2, 1, -11));  // (x, y) = (11, 2) of the world
  EXPECT_FALSE(is_ground(2, 1, -11));
  EXPECT_FALSE(is_ground(-11, 1, -2));
  dtFreeNavMeshQuery(query);
  dtFreeNavMesh(mesh);
}

/// Two floors, written as Habitat has it and read again.
class HabitatNavMeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_ = TwoFloors();
    bytes_ = *EncodeHabitatNavMesh(scene_, {});
    WriteText(path(), bytes_);
  }
  std::filesystem::path path() const { return folder_.path() / "two.navmesh"; }
  TempFolder folder_;
  Scene scene_;
  std::string bytes_;
};

TEST_F(HabitatNavMeshFile, GivesThePathsOfTheNavMeshThatWasWritten) {
  const auto built = NavMesh::Build(scene_, {});
  const auto read = NavMesh::ReadHabitat(path(), {});
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_NEAR(read->AreaM2(), built->AreaM2(), 0.02 * built->AreaM2());
  EXPECT_EQ(read->Floors().size(), built->Floors().size());
  Rng rng(3);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const auto a = built->RandomPoint(rng), b = built->RandomPoint(rng);
    const auto expected = built->Geodesic(*a, *b), actual = read->Geodesic(*a, *b);
    ASSERT_EQ(expected.has_value(), actual.has_value());
    if (!expected) continue;
    EXPECT_NEAR(*actual, *expected, 0.01 * *expected + 0.05);
    compared += std::abs(a->z() - b->z()) > 1;  // over the stairs, and so over borders of tiles
  }
  EXPECT_GT(compared, 5);
}

TEST_F(HabitatNavMeshFile, TruncatedOrAlteredIsAnErrorAndNeverACrash) {
  for (std::size_t size = 0; size < bytes_.size(); size += 1 + bytes_.size() / 97) {
    WriteText(path(), bytes_.substr(0, size));
    EXPECT_FALSE(NavMesh::ReadHabitat(path(), {})) << size;
  }
  Rng rng(4);
  for (int i = 0; i < 300; ++i) {
    std::string altered = bytes_;
    for (int k = 0; k < 4; ++k)
      altered[static_cast<std::size_t>(rng.Uniform() * static_cast<double>(altered.size()))] =
          static_cast<char>(rng.Uniform() * 256);
    WriteText(path(), altered);
    const auto read = NavMesh::ReadHabitat(path(), {});
    if (!read) {
      EXPECT_NE(read.error().Message().find("two.navmesh"), std::string::npos);
    }
  }
  EXPECT_FALSE(NavMesh::ReadHabitat(folder_.path() / "none.navmesh", {}));
}

TEST_F(HabitatNavMeshFile, IsOpenedBesideTheSceneWhereTheSettingAsksForIt) {
  scene_.folder = folder_.path();
  NavMeshSettings settings;
  settings.source = "habitat";
  EXPECT_TRUE(NavMesh::Open(scene_, settings));
  std::filesystem::remove(path());
  const auto missing = NavMesh::Open(scene_, settings);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().Message().find("navmesh.source"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::sim::test
