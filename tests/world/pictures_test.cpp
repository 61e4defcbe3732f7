// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/pictures.h"

#include <gtest/gtest.h>

#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/furniture/furniture_source.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/shell/scene_builder.h"
#include "crossnav/world/surface/textures.h"

namespace crossnav::world {
namespace {

TEST(Patterns, RepeatWithoutASeam) {
  for (Pattern pattern : {Pattern::kPlaster, Pattern::kCarpet}) {
    const auto texture = MakePattern(pattern, 3);
    int most = 0;
    for (int v = 0; v < texture.rgb.height; ++v) {
      const int jump =
          std::abs(int{texture.rgb.At(0, v).r} - int{texture.rgb.At(texture.rgb.width - 1, v).r});
      most = std::max(most, jump);
    }
    EXPECT_LT(most, 60);
  }
  EXPECT_TRUE(MakePattern(Pattern::kPlain, 1).rgb.empty());
}

TEST(FrontFace, OfAScreenIsItsScreenAndAChairHasNone) {
  ModelBuilder b("tv");
  b.Colour({10, 10, 10});
  b.mesh.AddBox({-0.5, -0.05, 0.1}, {0.5, 0, 0.7});      // the case
  b.mesh.AddBox({-0.45, 0, 0.15}, {0.45, 0.004, 0.65});  // the screen on it
  const auto face = FindFrontFace(b.Finish());
  ASSERT_TRUE(face.has_value());
  EXPECT_NEAR(face->x0, -0.45, 1e-6);
  EXPECT_NEAR(face->z1, 0.65, 1e-6);
  EXPECT_NEAR(face->y, 0.004, 1e-6);

  ModelBuilder ball("ball");
  ball.Colour({10, 10, 10});
  ball.mesh.AddEllipsoid({0, 0, 0.5}, {0.5, 0.5, 0.5});
  EXPECT_FALSE(FindFrontFace(ball.Finish()).has_value());
}

TEST(AddPicture, IsSeenFromTheFrontAndOnlyScreensGlow) {
  Rng rng(3);
  for (const bool is_screen : {false, true}) {
    ObjectModel model = *MakeFurniture("tv", rng);
    const std::size_t materials = model.materials.size();
    AddPicture(model, is_screen, rng);
    ASSERT_EQ(model.materials.size(), materials + 1);
    EXPECT_EQ(model.glowing.size(), is_screen ? 1U : 0U);
    SceneBuilder builder;
    builder.Place(model, Pose::Identity(), 0);
    const sim::Scene scene = builder.Finish("00001-Tv");
    const sim::RayCaster caster(scene);
    const auto hit = caster.Cast({0.05, 2, model.Bounds().Center().z()}, {0, -1, 0}, 5);
    ASSERT_TRUE(hit.has_value());
    const auto material = scene.mesh.triangle_material[hit->triangle];
    EXPECT_GE(scene.materials[material].texture, 0);
    EXPECT_EQ(builder.glowing.count(material), is_screen ? 1U : 0U);
  }
}

TEST(AddPicture, CopiesOfOneAssetShareItsTexturesButNotTheirPictures) {
  Rng rng(4);
  ObjectModel tv = *MakeFurniture("tv", rng);
  tv.asset_id = "Test#tv";
  tv.textures.push_back(MakePattern(Pattern::kPlanks, 1));
  tv.materials.front().texture = 0;
  tv.mesh.uvs.assign(tv.mesh.vertices.size(), {0, 0});
  ObjectModel other = tv;
  AddPicture(tv, true, rng);
  AddPicture(other, true, rng);
  SceneBuilder builder;
  builder.Place(tv, Pose::Identity(), 0);
  builder.Place(other, Pose::Identity(), 0);
  const sim::Scene scene = builder.Finish("00001-Tvs");
  ASSERT_EQ(scene.textures.size(), 3U);
  EXPECT_NE(scene.textures[1].rgb.data, scene.textures[2].rgb.data);
}

TEST(Pictures, DifferFromSeedToSeedAndRepeatWithIt) {
  Rng a(1), b(1), c(2);
  const auto first = MakePictureTexture(a);
  EXPECT_EQ(first.rgb.data, MakePictureTexture(b).rgb.data);
  EXPECT_NE(first.rgb.data, MakePictureTexture(c).rgb.data);
}

TEST(RenderedMesh, NamesNothing) {
  // A material or node named "chair" would reveal the category to an agent.
  Rng rng(5);
  SceneBuilder builder;
  const FurnitureSource source{nullptr, true};
  for (const char* kind : {"tv", "chair", "toilet", "bed", "couch", "potted plant"}) {
    builder.Place(*source.Make(kind, rng), Pose::Identity(), 0);
  }
  const std::string glb = EncodeRenderGlb(builder.Finish("00001-Names"));
  const std::string json = glb.substr(0, glb.find("BIN"));
  EXPECT_EQ(json.find("\"name\""), std::string::npos);
  for (const char* word : {"chair", "toilet", "tv", "bed", "couch", "sofa", "plant"}) {
    EXPECT_EQ(json.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace crossnav::world
