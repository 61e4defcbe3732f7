// SPDX-License-Identifier: MIT
// Models of whole homes with a file that names their objects.
#include "crossnav/homes/mesh_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "crossnav/core/rng.h"
#include "crossnav/homes/scene_import.h"
#include "home_maker.h"
#include "support/temp_folder.h"

namespace crossnav::homes {
namespace {

namespace fs = std::filesystem;

/// Centimetres, y up: a floor of 4 x 4 m, a chair of two parts, a sofa without a group of its own.
std::string RoomObj() {
  return "mtllib room.mtl\ng Floor\nusemtl wood\n" + test::ObjBox(1, 0, -10, 0, 400, 0, 400) +
         "g Chair.seat\nusemtl red\n" + test::ObjBox(9, 100, 0, 100, 150, 45, 150) +
         "g Chair.back\n" + test::ObjBox(17, 100, 45, 145, 150, 90, 150) + "g Rest\n" +
         test::ObjBox(25, 250, 0, 50, 350, 80, 250) + test::ObjBox(33, 20, 0, 380, 40, 20, 395);
}

constexpr const char* kObjects = R"({
  "format": 1, "up": "y", "unit_m": 0.01,
  "objects": [
    {"name": "floor", "parts": ["Floor"]},
    {"id": "chair-1", "name": "Dining chair", "parts": ["Chair.*"], "room": 3},
    {"id": "sofa-1", "category": "sofa",
     "box": {"center": [300, 40, 150], "size": [110, 90, 210], "yaw_deg": 0}}
  ]})";

class MeshScene : public testing::Test {
 protected:
  fs::path Write(const std::string& name, const std::string& text) {
    const fs::path file = folder_.path() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  Result<ImportReport> Import(const fs::path& model, const std::string& objects) {
    ImportOptions options;
    options.input = model;
    options.objects = Write("objects.json", objects);
    options.out_dir = folder_.path() / "scenes";
    return ImportScene(options);
  }

  void ExpectError(const std::string& objects, const std::vector<std::string>& parts) {
    const auto report = Import(Write("room.obj", RoomObj()), objects);
    ASSERT_FALSE(report.has_value()) << objects;
    for (const auto& part : parts) {
      EXPECT_NE(report.error().Message().find(part), std::string::npos) << report.error().Message();
    }
    EXPECT_FALSE(fs::exists(folder_.path() / "scenes"));
  }

  crossnav::test::TempFolder folder_;
};

TEST_F(MeshScene, AnObjAndItsObjectsBecomeAScene) {
  Write("room.mtl", "newmtl wood\nKd 0.5 0.25 0\nnewmtl red\nKd 1 0 0\n");
  const auto report = Import(Write("room.obj", RoomObj()), kObjects);
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_EQ(report->goals, (std::map<std::string, int>{{"chair", 1}, {"sofa", 1}}));
  ASSERT_EQ(report->floors.size(), 1U);
  EXPECT_NEAR(report->floors[0].height_m, 0, 0.06);
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  ASSERT_EQ(scene->instances.size(), 4U);
  const auto& chair = scene->instances[1];
  EXPECT_EQ(chair.name, "dining chair");
  EXPECT_EQ(chair.region, 3);
  // y up -> z up: the file's z points to -y.
  EXPECT_NEAR((chair.box.min - Vector3d(1, -1.5, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR((chair.box.max - Vector3d(1.5, -1, 0.9)).norm(), 0, 1e-4);
  EXPECT_NEAR((scene->instances[2].box.max - Vector3d(3.5, -0.5, 0.8)).norm(), 0, 1e-4);
  EXPECT_EQ(scene->instances[3].name, "unknown");
}

TEST_F(MeshScene, AGltfNamesItsNodesAndTheirDescendants) {
  // One square, placed twice below a node "Bed"; another node is the floor.
  std::string bin;
  const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}};
  bin.append(reinterpret_cast<const char*>(corners), sizeof(corners));
  const std::uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
  bin.append(reinterpret_cast<const char*>(indices), sizeof(indices));
  Write("home.bin", bin);
  const auto model = Write("home.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 3]}],
    "nodes": [{"name": "Bed", "children": [1, 2]},
              {"name": "a", "mesh": 0, "translation": [0, 0.5, 0]},
              {"mesh": 0, "translation": [0, 1, 0]},
              {"name": "Ground", "mesh": 0, "scale": [4, 1, 4]}],
    "meshes": [{"name": "square", "primitives":
                [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                   "min": [0, 0, 0], "max": [2, 0, 2]},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"uri": "home.bin", "byteLength": 60}]})");
  const auto report = Import(model, R"({"objects": [
      {"name": "bed", "parts": ["Bed"]}, {"name": "floor", "parts": ["Ground"]}]})");
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value());
  ASSERT_EQ(scene->instances.size(), 2U);
  EXPECT_EQ(scene->instances[0].category, "bed");
  EXPECT_NEAR(scene->instances[0].box.min.z(), 0.5, 1e-5);
  EXPECT_NEAR(scene->instances[0].box.max.z(), 1, 1e-5);
  EXPECT_NEAR(scene->instances[1].box.max.x(), 8, 1e-5);
}

TEST_F(MeshScene, ABoxMayBeTurned) {
  PartedModel model;
  model.mesh.vertices = {{2, 2, 0},  {2.1F, 2, 0},  {2, 2.1F, 0},
                         {2, -2, 0}, {2.1F, -2, 0}, {2, -1.9F, 0}};
  model.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  model.triangle_part = {-1, -1};
  ObjectsFile objects;
  objects.is_y_up = false;
  NamedObject bar{"bar", "bar", {}, ObjectBox{{0, 0, 0}, {8, 1, 1}, 0.785398}, 0};
  objects.objects = {bar};
  const auto scene = NameObjects(model, objects, "o");
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  EXPECT_EQ(scene->mesh.triangle_instance, (std::vector<std::int32_t>{1, 2}));
}

TEST_F(MeshScene, ErrorsNameTheKeyOrTheObject) {
  ExpectError("{", {"objects.json", "not readable JSON"});
  ExpectError("[]", {"is no JSON object"});
  ExpectError("{}", {"objects.json: objects", "is no list"});
  ExpectError(R"({"objects": [], "unit": 1})", {"objects.json: unit", "no known key"});
  ExpectError(R"({"objects": [], "up": "x"})", {": up", "neither"});
  ExpectError(R"({"objects": [], "unit_m": -1})", {": unit_m", "above 0"});
  ExpectError(R"({"objects": [{"parts": ["Floor"]}]})", {"objects[0]", "neither name"});
  ExpectError(R"({"objects": [{"name": "a"}]})", {"objects[0]", "neither parts nor box"});
  ExpectError(R"({"objects": [{"name": "a", "parts": [1]}]})", {"objects[0].parts"});
  ExpectError(R"({"objects": [{"name": "a", "box": {"min": [0, 0, 0], "max": [0, 1, 1]}}]})",
              {"objects[0].box", "no extent"});
  ExpectError(R"({"objects": [{"name": "a", "box": {"min": [0, 0], "max": [0, 1, 1]}}]})",
              {"objects[0].box.min", "three numbers"});
  ExpectError(R"({"objects": [{"id": "x", "name": "a", "parts": ["Sofa"]}]})",
              {"objects[0]", "'x' names no part", "Chair.back, Chair.seat, Floor, Rest"});
  ExpectError(R"({"objects": [{"name": "a", "box": {"min": [9, 9, 9], "max": [10, 10, 10]}}]})",
              {"objects[0]", "holds no triangle"});
}

TEST_F(MeshScene, AModelNeedsItsObjectsAndMustBeReadable) {
  ImportOptions options;
  options.input = Write("room.obj", RoomObj());
  options.out_dir = folder_.path() / "scenes";
  const auto without = ImportScene(options);
  ASSERT_FALSE(without.has_value());
  EXPECT_NE(without.error().what.find("--objects"), std::string::npos);
  for (const char* name : {"bad.obj", "bad.glb", "bad.gltf"}) {
    const auto report = Import(Write(name, "no model at all"), kObjects);
    ASSERT_FALSE(report.has_value()) << name;
    EXPECT_NE(report.error().where.find(name), std::string::npos) << report.error().Message();
  }
  EXPECT_FALSE(fs::exists(options.out_dir));
}

TEST_F(MeshScene, DamagedObjectFilesNeverCrash) {
  const std::string whole = kObjects;
  Rng rng(5);
  for (int round = 0; round < 2000; ++round) {
    std::string text = whole;
    for (int k = rng.Int(1, 3); k > 0; --k) {
      const auto at = rng.Below(static_cast<std::uint32_t>(text.size()));
      if (rng.Below(2) == 0) {
        text.erase(at, rng.Below(12));
      } else {
        text[at] = static_cast<char>(rng.Below(256));
      }
      if (text.empty()) text = "x";
    }
    const auto objects = ParseObjectsFile(text, "damaged");
    EXPECT_TRUE(objects || objects.error().where.rfind("damaged", 0) == 0);
  }
}

}  // namespace
}  // namespace crossnav::homes
