// SPDX-License-Identifier: MIT
#include "crossnav/world/scene/scene_writer.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "crossnav/core/write_file.h"
#include "crossnav/world/scene/backs.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/shell/scene_builder.h"
#include "sim/micro_scene.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::world {
namespace {

sim::Scene TwoBoxes() {
  SceneBuilder scene;
  scene.BeginInstance("wall", 3);
  scene.mesh.material = scene.Material({200, 100, 50});
  scene.mesh.AddBox({1, 2, 3}, {2, 3, 4});
  scene.BeginInstance("never drawn", 0);
  scene.BeginInstance("couch", 4);
  scene.mesh.material = scene.Material({10, 20, 30});
  scene.mesh.AddBox({5, 5, 0}, {6, 7, 1});
  scene.mesh.material = scene.Material({200, 100, 50});
  scene.mesh.AddBox({8, 5, 0}, {9, 7, 1});
  return scene.Finish("00042-Boxes");
}

/// Regression: Habitat-Sim showed the wall behind a leaf, because it draws fronts alone.
TEST(SceneWriter, OpenAndInvertedThingsGetBacksAndClosedThingsDoNot) {
  const sim::Scene boxes = TwoBoxes();
  EXPECT_EQ(WithBacks(boxes).mesh.triangles, boxes.mesh.triangles);

  sim::Scene leaf = boxes;
  leaf.mesh.triangles.pop_back();  // a hole in the last box of the couch
  leaf.mesh.triangle_material.pop_back();
  leaf.mesh.triangle_instance.pop_back();
  const std::size_t of_wall = 12, all = leaf.mesh.triangles.size();
  const sim::Scene backed = WithBacks(leaf);
  ASSERT_EQ(backed.mesh.triangles.size(), 2 * all - of_wall);
  for (std::size_t t = of_wall; t < all; ++t) {
    const auto& front = backed.mesh.triangles[t];
    const auto& back = backed.mesh.triangles[all + t - of_wall];
    EXPECT_EQ(back, (std::array<std::uint32_t, 3>{front[2], front[1], front[0]}));
    EXPECT_EQ(backed.mesh.triangle_instance[all + t - of_wall], backed.mesh.triangle_instance[t]);
  }

  sim::Scene inverted = boxes;
  for (auto& triangle : inverted.mesh.triangles) std::swap(triangle[0], triangle[2]);
  EXPECT_EQ(WithBacks(inverted).mesh.triangles.size(), 2 * boxes.mesh.triangles.size());
}

TEST(SceneWriter, SemanticColoursAsLightAreTheSameNamesToTheReader) {
  const test::TempFolder dir;
  const sim::Scene scene = TwoBoxes();
  const auto folder = WriteScene(scene, dir.path());
  ASSERT_TRUE(folder.has_value());
  const auto before = sim::LoadScene(*folder);
  const std::string linear = EncodeSemanticGlb(scene, SemanticColours::kLinear);
  EXPECT_NE(linear, EncodeSemanticGlb(scene));
  ASSERT_TRUE(WriteFileAtomically(*folder / "Boxes.semantic.glb", linear));
  const auto after = sim::LoadScene(*folder);
  ASSERT_TRUE(after.has_value()) << after.error().Message();
  EXPECT_EQ(after->mesh.triangle_instance, before->mesh.triangle_instance);
  EXPECT_EQ(after->mesh_hash, before->mesh_hash);
}

TEST(SceneWriter, AWrittenSceneIsReadUnchanged) {
  const test::TempFolder dir;
  const sim::Scene scene = TwoBoxes();
  const auto folder = WriteScene(scene, dir.path());
  ASSERT_TRUE(folder.has_value()) << folder.error().Message();
  const auto read = sim::LoadScene(*folder);
  ASSERT_TRUE(read.has_value()) << read.error().Message();
  EXPECT_EQ(read->id, "00042-Boxes");
  ASSERT_EQ(read->instances.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read->instances[i].id, scene.instances[i].id);
    EXPECT_EQ(read->instances[i].name, scene.instances[i].name);
    EXPECT_EQ(read->instances[i].region, scene.instances[i].region);
    EXPECT_TRUE(read->instances[i].box.min.isApprox(scene.instances[i].box.min, 1e-6));
    EXPECT_TRUE(read->instances[i].box.max.isApprox(scene.instances[i].box.max, 1e-6));
  }
  EXPECT_EQ(read->instances[1].category, "sofa");
  ASSERT_EQ(read->mesh.triangles.size(), 36U);
  std::multiset<std::pair<int, int>> before, after;  // (instance, colour)
  for (std::size_t t = 0; t < 36; ++t) {
    before.emplace(scene.mesh.triangle_instance[t],
                   scene.materials[scene.mesh.triangle_material[t]].colour.r);
    after.emplace(read->mesh.triangle_instance[t],
                  read->materials[read->mesh.triangle_material[t]].colour.r);
  }
  EXPECT_EQ(before, after);
}

TEST(SceneWriter, FileFrameIsZUpWithXToMinusY) {
  SceneBuilder scene;
  scene.BeginInstance("wall", 0);
  scene.mesh.material = scene.Material({1, 2, 3});
  scene.mesh.AddTriangle({1, 2, 3}, {4, 2, 3}, {1, 7, 3});
  const std::string glb = EncodeRenderGlb(scene.Finish("00001-Frame"));
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, glb.data() + 12, 4);
  float p[3];
  std::memcpy(p, glb.data() + 20 + json_size + 8, sizeof p);
  EXPECT_FLOAT_EQ(p[0], -2);  // x_f = -y_world
  EXPECT_FLOAT_EQ(p[1], 1);   // y_f = x_world
  EXPECT_FLOAT_EQ(p[2], 3);
}

TEST(SceneWriter, SameSceneGivesTheSameBytes) {
  EXPECT_EQ(EncodeRenderGlb(TwoBoxes()), EncodeRenderGlb(TwoBoxes()));
  EXPECT_EQ(EncodeSemanticGlb(TwoBoxes()), EncodeSemanticGlb(TwoBoxes()));
}

TEST(SceneWriter, SemanticTextFollowsHm3d) {
  std::istringstream text(SemanticText(TwoBoxes()));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "HM3D Semantic Annotations");
  std::getline(text, line);
  EXPECT_EQ(line, "1,9E3779,\"wall\",3");
}

TEST(SceneWriter, ColoursAsShownAreTheBytesOfThePictureAsNumbers) {
  sim::test::MicroScene micro;
  micro.Begin("box");
  micro.Box({0, 0, 0}, {1, 1, 1});
  micro.scene().materials = {{{40, 120, 200}}};
  micro.scene().mesh.vertex_colours.assign(micro.scene().mesh.vertices.size(), {30, 90, 220});
  sim::Scene scene = micro.Finish();
  scene.id = "00001-Box";
  const std::string glb = EncodeRenderGlb(scene, RenderColours::kAsShown);
  const std::string text = glb.substr(20, glb.find("BIN") - 24);
  const auto json = nlohmann::json::parse(text);
  const auto factor = json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_NEAR(factor[0].get<double>() * 255, 40, 1e-6);
  EXPECT_NEAR(factor[2].get<double>() * 255, 200, 1e-6);
  const std::uint16_t shown[] = {30 * 257, 90 * 257, 220 * 257};
  EXPECT_NE(glb.find(std::string(reinterpret_cast<const char*>(shown), sizeof(shown))),
            std::string::npos);
  EXPECT_NE(glb, EncodeRenderGlb(scene));
}

TEST(SceneWriter, SemanticColoursAreDistinct) {
  std::set<int> seen;
  for (int id = 1; id < 70000; ++id) {
    const Rgb8 c = SemanticColour(id);
    EXPECT_TRUE(seen.insert(c.r << 16 | c.g << 8 | c.b).second) << id;
  }
}

TEST(SceneWriter, LeavesNoHalfWrittenFileAndListsTheScene) {
  const test::TempFolder dir;
  ASSERT_TRUE(WriteScene(TwoBoxes(), dir.path()).has_value());
  for (const auto& e : std::filesystem::recursive_directory_iterator(dir.path())) {
    EXPECT_NE(e.path().extension(), ".part");
  }
  const std::string config = test::ReadText(dir.path() / "crossnav.scene_dataset_config.json");
  EXPECT_NE(config.find("00042-Boxes/Boxes.glb"), std::string::npos);
}

TEST(SceneWriter, AFullDiskLeavesTheSceneThatWasThereWhole) {
  const test::TempFolder dir;
  const auto folder = WriteScene(TwoBoxes(), dir.path(), "{}");
  ASSERT_TRUE(folder.has_value());
  const auto files = [&] {
    std::map<std::string, std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(*folder))
      found[entry.path().filename().string()] = test::ReadText(entry.path());
    return found;
  };
  const auto before = files();
  sim::Scene other = TwoBoxes();
  other.instances[0].name = "another wall";
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};  // the texts fit, the meshes do not
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(WriteScene(other, dir.path(), "{\"rooms\":[]}") ? 1 : 0);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << "it was called a success";
  EXPECT_EQ(files(), before);
}

TEST(SceneWriter, RefusesBadIdsAndEmptyScenes) {
  const test::TempFolder dir;
  sim::Scene scene = TwoBoxes();
  scene.id = "nodash";
  EXPECT_FALSE(WriteScene(scene, dir.path()).has_value());
  EXPECT_FALSE(WriteScene(SceneBuilder().Finish("00001-Empty"), dir.path()).has_value());
  const std::filesystem::path file = dir.path() / "file";
  std::ofstream(file) << "x";
  const auto below_file = WriteScene(TwoBoxes(), file);
  ASSERT_FALSE(below_file.has_value());
  EXPECT_EQ(below_file.error().code, ErrorCode::kIo);
}

TEST(SceneWriter, TexturesSurviveTheRoundTrip) {
  const test::TempFolder dir;
  SceneBuilder scene;
  sim::Texture texture;
  texture.rgb = RgbImage(4, 2);
  for (int u = 0; u < 4; ++u) {
    for (int v = 0; v < 2; ++v)
      texture.rgb.At(u, v) = {std::uint8_t(60 * u), std::uint8_t(90 * v), 7};
  }
  texture.opaque = MaskImage(4, 2, 1);
  texture.opaque.At(3, 1) = 0;
  const int index = scene.AddTexture(texture);
  scene.BeginInstance("rug", 0);
  scene.mesh.material = scene.Material({255, 255, 255}, index);
  scene.mesh.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const auto folder = WriteScene(scene.Finish("00001-Rug"), dir.path());
  ASSERT_TRUE(folder.has_value());
  const auto read = sim::LoadScene(*folder);
  ASSERT_TRUE(read.has_value()) << read.error().Message();
  ASSERT_EQ(read->textures.size(), 1U);
  EXPECT_EQ(read->textures[0].rgb.data, texture.rgb.data);
  EXPECT_EQ(read->textures[0].opaque.data, texture.opaque.data);
}

}  // namespace
}  // namespace crossnav::world
