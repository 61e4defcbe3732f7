// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "crossnav/sim/scene/scene_reader.h"
#include "glb_maker.h"
#include "micro_scene.h"
#include "support/temp_folder.h"

namespace crossnav::sim::test {
namespace {

namespace fs = std::filesystem;
using crossnav::test::TempFolder;

void Write(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}
void Write(const fs::path& file, const std::string& text) {
  Write(file, std::vector<std::uint8_t>(text.begin(), text.end()));
}

/// Two triangles in the file frame; the second is `shift` metres along x_f from where it should be.
std::vector<float> TwoTriangles(float shift) {
  return {0, 0, 0, 1, 0, 0, 0, 1, 0, 5 + shift, 0, 2, 6 + shift, 0, 2, 5 + shift, 1, 2};
}

std::vector<std::uint8_t> RenderGlb() {
  GlbMaker maker;
  maker.AddMesh({{"attributes", {{"POSITION", maker.Positions(TwoTriangles(0))}}}});
  return maker.Bytes();
}

std::vector<std::uint8_t> SemanticGlb(float shift) {
  GlbMaker maker;
  std::vector<std::uint8_t> colours;
  for (int v = 0; v < 6; ++v)
    for (const int channel :
         v < 3 ? std::array{0x59, 0x3A, 0x3A, 255} : std::array{0x1F, 0x3D, 0x87, 255})
      colours.push_back(static_cast<std::uint8_t>(channel));
  const int position = maker.Positions(TwoTriangles(shift));
  const int colour = maker.Accessor(colours, GlbMaker::kByte, "VEC4", 4, true);
  maker.AddMesh({{"attributes", {{"POSITION", position}, {"COLOR_0", colour}}}});
  return maker.Bytes();
}

constexpr char kText[] =
    "HM3D Semantic Annotations\n4,593A3A,\"floor\",0\n9,1F3D87,\"armchair\",3\n";

fs::path WriteScene(const fs::path& root, float shift = 0) {
  const fs::path folder = root / "00007-AbcDef";
  Write(folder / "AbcDef.glb", RenderGlb());
  Write(folder / "AbcDef.semantic.glb", SemanticGlb(shift));
  Write(folder / "AbcDef.semantic.txt", std::string(kText));
  Write(folder / "notes.json", std::string("{}"));
  return folder;
}

TEST(LoadScene, ReadsTheLayoutOfHm3dIntoTheWorldFrame) {
  const TempFolder temp;
  const auto scene = LoadScene(WriteScene(temp.path()));
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  EXPECT_EQ(scene->id, "00007-AbcDef");
  // (x, y, z)_world = (y, -x, z)_file.
  EXPECT_EQ(scene->mesh.vertices[1], Vector3f(0, -1, 0));
  EXPECT_EQ(scene->mesh.vertices[5], Vector3f(1, -5, 2));
  EXPECT_EQ(scene->mesh.triangle_instance, (std::vector<std::int32_t>{4, 9}));
  ASSERT_EQ(scene->instances.size(), 2U);
  const SceneInstance* chair = scene->FindInstance(9);
  ASSERT_NE(chair, nullptr);
  EXPECT_EQ(chair->category, "chair");
  EXPECT_EQ(chair->region, 3);
  EXPECT_EQ(chair->box.min, Vector3d(0, -6, 2));
  EXPECT_EQ(chair->box.max, Vector3d(1, -5, 2));
  EXPECT_EQ(scene->FindInstance(5), nullptr);
}

TEST(LoadScene, NearlyEqualSemanticMeshesAreMatchedByNearestSurface) {
  const TempFolder temp;
  const auto near = LoadScene(WriteScene(temp.path(), 0.03F));
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->mesh.triangle_instance, (std::vector<std::int32_t>{4, 9}));
  const auto far = LoadScene(WriteScene(temp.path(), 2.0F));
  ASSERT_TRUE(far.has_value());
  EXPECT_EQ(far->mesh.triangle_instance, (std::vector<std::int32_t>{4, 0}));
}

TEST(LoadScene, AReplacedCategoryTableIsUsed) {
  const TempFolder temp;
  const auto scene = LoadScene(WriteScene(temp.path()), {{"floor", "bed"}});
  ASSERT_TRUE(scene.has_value());
  EXPECT_EQ(scene->FindInstance(4)->category, "bed");
  EXPECT_EQ(scene->FindInstance(9)->category, "");
}

TEST(LoadScene, TheHashDependsOnGeometryAndSemanticsOnly) {
  const TempFolder a, b, c;
  const auto one = LoadScene(WriteScene(a.path()));
  const auto same = LoadScene(WriteScene(b.path()));
  const auto other = LoadScene(WriteScene(c.path()), CategoryTable{});
  EXPECT_EQ(one->mesh_hash, same->mesh_hash);
  EXPECT_NE(one->mesh_hash, other->mesh_hash);
}

TEST(LoadScene, NamesTheMissingFile) {
  const TempFolder temp;
  const auto none = LoadScene(temp.path() / "nowhere");
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
  const fs::path folder = WriteScene(temp.path());
  fs::remove(folder / "AbcDef.semantic.txt");
  const auto half = LoadScene(folder);
  ASSERT_FALSE(half.has_value());
  EXPECT_NE(half.error().Message().find(".semantic.txt"), std::string::npos);
  Write(folder / "AbcDef.semantic.txt", std::string("HM3D Semantic Annotations\nrubbish\n"));
  const auto broken = LoadScene(folder);
  ASSERT_FALSE(broken.has_value());
  EXPECT_NE(broken.error().where.find("AbcDef.semantic.txt, line 2"), std::string::npos);
}

TEST(LoadScene, WithoutSemanticFilesThereAreNoInstances) {
  const TempFolder temp;
  Write(temp.path() / "00001-x" / "x.glb", RenderGlb());
  const auto scene = LoadScene(temp.path() / "00001-x");
  ASSERT_TRUE(scene.has_value());
  EXPECT_TRUE(scene->instances.empty());
}

TEST(FindScene, FindsFoldersByIdHashAndHabitatPath) {
  const TempFolder temp;
  const fs::path folder = WriteScene(temp.path() / "val");
  for (const char* id : {"00007-AbcDef", "AbcDef", "hm3d/val/00007-AbcDef/AbcDef.basis.glb",
                         "val/00007-AbcDef/AbcDef.glb", "00007-AbcDef/"}) {
    const auto found = FindScene(temp.path(), id);
    ASSERT_TRUE(found.has_value()) << id;
    EXPECT_EQ(*found, folder) << id;
  }
  for (const char* id : {"", "..", "Def", "00007", "AbcDef2"}) {
    EXPECT_FALSE(FindScene(temp.path(), id).has_value()) << id;
  }
}

TEST(TransferInstances, AgreesWithBruteForceOnRandomTriangles) {
  // Oracle: sample-based nearest surface is slow; here each target triangle is a copy moved by up
  // to 2 cm along its normal, and sources are at least 0.5 m apart.
  TriangleMesh source, target;
  for (int i = 0; i < 50; ++i) {
    const int column = i % 10, row = i / 10;
    const Vector3f at(static_cast<float>(column), static_cast<float>(row), 0.2F);
    for (TriangleMesh* mesh : {&source, &target}) {
      const auto base = static_cast<std::uint32_t>(mesh->vertices.size());
      const float off = mesh == &target ? 0.02F * static_cast<float>(i % 2) : 0.0F;
      mesh->vertices.push_back(at + Vector3f(0, 0, off));
      mesh->vertices.push_back(at + Vector3f(0.4F, 0, off));
      mesh->vertices.push_back(at + Vector3f(0, 0.4F, off));
      mesh->triangles.push_back({base, base + 1, base + 2});
    }
    source.triangle_instance.push_back(i + 1);
  }
  const auto instance = TransferInstances(source, target, 0.05);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(instance[static_cast<std::size_t>(i)], i + 1);
}

}  // namespace
}  // namespace crossnav::sim::test
