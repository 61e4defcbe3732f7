// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/navmesh/navmesh_detail.h"
#include "micro_scene.h"
#include "support/temp_folder.h"

namespace crossnav::sim::test {
namespace {

namespace fs = std::filesystem;
using crossnav::test::TempFolder;

std::vector<fs::path> CachesIn(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
  return found;
}

/// Each test has a separate user cache, so that no file of an earlier run is found.
class NavMeshCache : public ::testing::Test {
 protected:
  NavMeshCache() {
    if (const char* before = std::getenv("XDG_CACHE_HOME")) before_ = before;
    ::setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
  }
  ~NavMeshCache() override {
    before_ ? ::setenv("XDG_CACHE_HOME", before_->c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
  }

  TempFolder cache_;
  std::optional<std::string> before_;
};

TEST_F(NavMeshCache, TheCachedMeshAnswersAsTheBuiltOne) {
  const TempFolder temp;
  Scene scene = TwoFloors();
  scene.folder = temp.path();
  const auto built = NavMesh::BuildCached(scene, {});
  ASSERT_EQ(CachesIn(temp.path()).size(), 1U);
  const auto cached = NavMesh::BuildCached(scene, {});
  ASSERT_TRUE(built.has_value() && cached.has_value());
  EXPECT_EQ(built->Hash(), cached->Hash());
  EXPECT_EQ(built->AreaM2(), cached->AreaM2());
  EXPECT_EQ(built->Floors().size(), cached->Floors().size());
  Rng rng(1);
  for (int i = 0; i < 40; ++i) {
    const Vector3d a = *built->RandomPoint(rng), b = *built->RandomPoint(rng);
    EXPECT_EQ(built->Geodesic(a, b), cached->Geodesic(a, b));
    EXPECT_EQ(built->WalkStraight(a, b), cached->WalkStraight(a, b));
  }
}

TEST_F(NavMeshCache, OtherSettingsOrAnotherMeshHaveAnotherFile) {
  const TempFolder temp;
  Scene scene = TwoFloors();
  scene.folder = temp.path();
  (void)NavMesh::BuildCached(scene, {});
  NavMeshSettings settings;
  settings.agent_radius_m = 0.2;
  (void)NavMesh::BuildCached(scene, settings);
  scene.mesh_hash += 1;
  (void)NavMesh::BuildCached(scene, {});
  EXPECT_EQ(CachesIn(temp.path()).size(), 3U);
}

TEST_F(NavMeshCache, AFolderThatCannotBeWrittenToHasItsCacheElsewhere) {
  const TempFolder temp;
  Scene scene = TwoFloors();
  scene.folder = temp.path() / "file";  // not even the administrator can write below a file
  std::ofstream(scene.folder) << "x";
  const auto built = NavMesh::BuildCached(scene, {});
  ASSERT_TRUE(built.has_value());
  const auto files = CachesIn(cache_.path() / "crossnav" / "scenes");
  ASSERT_EQ(files.size(), 1U);
  const auto written = fs::last_write_time(files[0]);
  EXPECT_EQ(NavMesh::BuildCached(scene, {})->Hash(), built->Hash());
  EXPECT_EQ(fs::last_write_time(files[0]), written);
}

TEST_F(NavMeshCache, DamagedFilesAreBuiltAnew) {
  const TempFolder temp;
  Scene scene = TwoFloors();
  scene.folder = temp.path();
  const auto built = NavMesh::BuildCached(scene, {});
  const fs::path file = CachesIn(temp.path()).at(0);
  const auto size = fs::file_size(file);
  for (const std::uintmax_t cut : {std::uintmax_t{0}, size / 2, size - 1}) {
    fs::resize_file(file, cut);
    const auto again = NavMesh::BuildCached(scene, {});
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->Hash(), built->Hash());
    EXPECT_EQ(fs::file_size(file), size);  // and repaired
  }
}

TEST_F(NavMeshCache, NoFlippedByteGetsThrough) {
  const Scene scene = TwoFloors();
  const auto mesh = BuildDetour(scene, {});
  ASSERT_TRUE(mesh.has_value());
  const auto bytes = SaveTiles(**mesh, 42);
  ASSERT_NE(LoadTiles(bytes, 42), nullptr);
  EXPECT_EQ(LoadTiles(bytes, 43), nullptr);
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    auto broken = bytes;
    broken[rng.Below(static_cast<std::uint32_t>(bytes.size()))] ^= 1U << rng.Below(8);
    EXPECT_EQ(LoadTiles(broken, 42), nullptr);
  }
}

TEST_F(NavMeshCache, AFolderThatCannotBeWrittenToIsNoError) {
  Scene scene = TwoFloors();
  scene.folder = "/nonexistent/folder";
  EXPECT_TRUE(NavMesh::BuildCached(scene, {}).has_value());
}

}  // namespace
}  // namespace crossnav::sim::test
