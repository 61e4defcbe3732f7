// SPDX-License-Identifier: MIT
// Models in a home's archive: formats are told by their bytes, also inside zip files.
#include "crossnav/homes/model_store.h"

#include <gtest/gtest.h>

#include "home_maker.h"
#include "support/temp_folder.h"

namespace crossnav::homes {
namespace {

constexpr const char* kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 2 0 0 0 3 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";

std::optional<std::string> Nothing(const std::string& /*name*/) {
  return std::nullopt;
}

TEST(ModelStore, ReadsAnObjInAZipWithItsMaterials) {
  const std::string zip = crossnav::test::Zip(
      {{"a/chair.obj", "mtllib m.mtl\nusemtl red\n" + test::ObjBox(1, 0, 0, 0, 1, 1, 1)},
       {"a/m.mtl", "newmtl red\nKd 1 0 0\n"},
       {"readme.txt", "hello"}});
  const auto model = ParseModel(zip, Nothing, "7");
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  EXPECT_EQ(model->model.mesh.triangles.size(), 12U);
  EXPECT_EQ(model->model.materials[0].colour, (Rgb8{255, 0, 0}));
  EXPECT_FALSE(ParseModel(crossnav::test::Zip({{"a.txt", "x"}}), Nothing, "8").has_value());
  const auto nested = crossnav::test::Zip({{"a.obj", zip}});
  EXPECT_FALSE(ParseModel(nested, Nothing, "9").has_value());
}

TEST(ModelStore, ReadsColladaWhereAssimpIsBuiltIn) {
  const auto model = ParseModel(kCollada, Nothing, "lamp");
  if (!model && model.error().code == ErrorCode::kUnsupported) {
    GTEST_SKIP() << model.error().what;
  }
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  ASSERT_EQ(model->model.mesh.triangles.size(), 1U);
  EXPECT_NEAR(model->model.Bounds().max.y(), 3, 1e-5);
  const auto broken = ParseModel(std::string(kCollada).substr(0, 700), Nothing, "lamp");
  EXPECT_FALSE(broken.has_value());
}

TEST(ModelStore, HeavyModelsGetFewerTrianglesAndKeepTheirShape) {
  std::string heavy;
  const int n = 150;  // a grid of 150 x 150 squares
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) {
      heavy += "v " + std::to_string(i) + " 0 " + std::to_string(k) + "\n";
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const int a = i * (n + 1) + k + 1, b = a + n + 1;
      heavy += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) +
               " " + std::to_string(a + 1) + "\n";
    }
  }
  const crossnav::test::TempFolder folder;
  const auto file = test::WriteArchive(folder.path() / "a.zip", {{"0", heavy}});
  const auto contents = Contents::Open(file);
  ASSERT_TRUE(contents.has_value());
  ModelStore models(*contents);
  std::string why;
  const auto* model = models.Find("0", why);
  ASSERT_NE(model, nullptr) << why;
  EXPECT_LE(model->model.mesh.triangles.size(), 20'000U);
  EXPECT_EQ(model->triangle_group.size(), model->model.mesh.triangles.size());
  EXPECT_NEAR(model->model.Bounds().max.x(), n, 1e-3);
  EXPECT_EQ(models.Find("absent", why), nullptr);
  EXPECT_NE(why.find("not in the archive"), why.npos);
}

TEST(ModelStore, MaterialsWithoutAFileHaveColours) {
  const auto model =
      ParseModel("usemtl flblonde\n" + test::ObjBox(1, 0, 0, 0, 1, 1, 1), Nothing, "0");
  ASSERT_TRUE(model.has_value());
  EXPECT_EQ(model->model.materials[0].colour, *BuiltInColour("flblonde"));
  EXPECT_FALSE(BuiltInColour("no such").has_value());
}

}  // namespace
}  // namespace crossnav::homes
