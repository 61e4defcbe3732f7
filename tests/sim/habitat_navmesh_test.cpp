// SPDX-License-Identifier: MIT
// The bytes are read as habitat-sim reads them.
#include "crossnav/sim/navmesh/habitat_navmesh.h"

#include <gtest/gtest.h>
#include <recastnavigation/DetourAlloc.h>
#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshQuery.h>

#include <cstring>

namespace crossnav::sim::test {
namespace {

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

}  // namespace
}  // namespace crossnav::sim::test
