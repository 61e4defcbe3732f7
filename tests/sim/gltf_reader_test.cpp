// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/gltf_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "glb_maker.h"
#include "support/png_bytes.h"

namespace crossnav::sim::test {
namespace {

using nlohmann::json;

GltfModel Parse(const GlbMaker& maker, const GltfOptions& options = {}) {
  const auto bytes = maker.Bytes();
  auto model = ParseGlb(bytes, "test.glb", {}, options);
  if (!model) {
    ADD_FAILURE() << model.error().Message();
    return {};
  }
  return *model;
}

std::string ErrorOf(const GlbMaker& maker) {
  const auto bytes = maker.Bytes();
  const auto model = ParseGlb(bytes, "test.glb", {});
  return model ? "no error" : model.error().Message();
}

template <class T>
int SquareIndices(GlbMaker& maker, int component_type) {
  return maker.Accessor(std::vector<T>{0, 1, 2, 0, 2, 3}, component_type, "SCALAR", 1);
}

TEST(GltfReader, IndicesOfEveryWidthGiveTheSameTriangles) {
  for (const int type : {GlbMaker::kByte, GlbMaker::kShort, GlbMaker::kInt}) {
    GlbMaker maker;
    const int position = maker.Positions(SquareCorners());
    const int indices = type == GlbMaker::kByte    ? SquareIndices<std::uint8_t>(maker, type)
                        : type == GlbMaker::kShort ? SquareIndices<std::uint16_t>(maker, type)
                                                   : SquareIndices<std::uint32_t>(maker, type);
    maker.AddMesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    const GltfModel model = Parse(maker);
    ASSERT_EQ(model.mesh.triangles.size(), 2U);
    EXPECT_EQ(model.mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(model.mesh.vertices[2], Vector3f(1, 1, 0));
  }
}

TEST(GltfReader, WithoutIndicesEveryThreeVerticesAreATriangle) {
  GlbMaker maker;
  const int position = maker.Positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0});
  maker.AddMesh({{"attributes", {{"POSITION", position}}}});
  const GltfModel model = Parse(maker);
  ASSERT_EQ(model.mesh.triangles.size(), 2U);
  EXPECT_EQ(model.mesh.triangles[1], (std::array<std::uint32_t, 3>{3, 4, 5}));
}

TEST(GltfReader, StripsAndFansKeepTheirWinding) {
  for (const int mode : {5, 6}) {
    GlbMaker maker;
    const std::vector<float> strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const int position = maker.Positions(mode == 5 ? strip : SquareCorners());
    maker.AddMesh({{"attributes", {{"POSITION", position}}}, {"mode", mode}});
    const GltfModel model = Parse(maker);
    ASSERT_EQ(model.mesh.triangles.size(), 2U);
    for (const auto& t : model.mesh.triangles) {
      const auto& v = model.mesh.vertices;
      EXPECT_NEAR((v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).z(), 1, 1e-6);
    }
  }
}

TEST(GltfReader, NodeTransformsMultiplyDownTheTree) {
  GlbMaker maker;
  const int position = maker.Positions({1, 0, 0, 2, 0, 0, 1, 1, 0});
  maker.json["meshes"] =
      json::array({{{"primitives", json::array({{{"attributes", {{"POSITION", position}}}}})}}});
  // Child: scale by 2, turn by 90 degrees about z. Parent: moved by (10, 20, 30).
  maker.json["nodes"] = {
      {{"translation", {10, 20, 30}}, {"children", {1}}},
      {{"mesh", 0}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, 0.70710678118, 0.70710678118}}}};
  maker.json["scenes"] = {{{"nodes", {0}}}};
  const GltfModel model = Parse(maker);
  ASSERT_EQ(model.mesh.vertices.size(), 3U);
  EXPECT_LT((model.mesh.vertices[0] - Vector3f(10, 22, 30)).norm(), 1e-4);
  EXPECT_LT((model.mesh.vertices[2] - Vector3f(8, 22, 30)).norm(), 1e-4);
}

TEST(GltfReader, LinearBaseColourBecomesSrgb) {
  GlbMaker maker;
  const int position = maker.Positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1.0, 0.2158605, 0.0, 1.0}}}}}};
  maker.AddMesh({{"attributes", {{"POSITION", position}}}, {"material", 0}});
  const GltfModel model = Parse(maker);
  EXPECT_EQ(model.materials[model.mesh.triangle_material[0]].colour, (Rgb8{255, 128, 0}));
  EXPECT_FALSE(model.materials[model.mesh.triangle_material[0]].is_unlit);
  maker.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", nlohmann::json::object()}};
  const GltfModel unlit = Parse(maker);
  EXPECT_TRUE(unlit.materials[unlit.mesh.triangle_material[0]].is_unlit);
}

TEST(GltfReader, RawVertexColoursKeepTheirNumbersAndThoseOf16BitsAreLinearLight) {
  const std::vector<std::uint8_t> bytes{0x59, 0x3A, 0x3A, 255,  0x59, 0x3A,
                                        0x3A, 255,  0x59, 0x3A, 0x3A, 255};
  std::vector<std::uint16_t> shorts;
  std::vector<float> floats;
  for (const std::uint8_t b : bytes) {
    const double s = b / 255.0;
    shorts.push_back(static_cast<std::uint16_t>(
        std::lround(65535 * (s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4)))));
    floats.push_back(static_cast<float>(b) / 255);
  }
  for (int kind = 0; kind < 3; ++kind) {
    GlbMaker maker;
    const int position = maker.Positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int colour = kind == 0   ? maker.Accessor(bytes, GlbMaker::kByte, "VEC4", 4, true)
                       : kind == 1 ? maker.Accessor(shorts, GlbMaker::kShort, "VEC4", 4, true)
                                   : maker.Accessor(floats, GlbMaker::kFloat, "VEC4", 4);
    maker.AddMesh({{"attributes", {{"POSITION", position}, {"COLOR_0", colour}}}});
    const GltfModel model = Parse(maker, {.raw_vertex_colours = true});
    ASSERT_EQ(model.mesh.vertex_colours.size(), 3U);
    EXPECT_EQ(model.mesh.vertex_colours[1], (Rgb8{0x59, 0x3A, 0x3A})) << "kind " << kind;
  }
}

GlbMaker TexturedTriangle(const std::vector<std::uint8_t>& image_bytes, const char* mime) {
  GlbMaker maker;
  const int position = maker.Positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uv = maker.Accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, GlbMaker::kFloat, "VEC2", 2);
  const int view = maker.View(image_bytes);
  maker.json["images"] = {{{"bufferView", view}, {"mimeType", mime}}};
  maker.json["textures"] = {{{"source", 0}}};
  maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  maker.AddMesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"material", 0}});
  return maker;
}

TEST(GltfReader, EmbeddedPngIsDecodedTopRowFirst) {
  RgbImage image(2, 2);
  image.At(0, 0) = {255, 0, 0};
  image.At(1, 1) = {0, 0, 255};
  const GltfModel model = Parse(TexturedTriangle(crossnav::test::PngBytes(image), "image/png"));
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.textures[0].rgb.data, image.data);
  EXPECT_EQ(model.materials[0].texture, 0);
  EXPECT_TRUE(model.notes.empty());
}

TEST(GltfReader, BrokenBasisImagesFallBackToAFlatColourWithANote) {
  std::vector<std::uint8_t> broken(64, 0x73);
  broken[1] = 'B';
  for (const char* extension : {"GOOGLE_texture_basis", "KHR_texture_basisu"}) {
    GlbMaker maker = TexturedTriangle(broken, "image/x-basis");
    maker.json["textures"] = {{{"extensions", {{extension, {{"source", 0}}}}}}};
    maker.json["extensionsUsed"] = {extension};
    const GltfModel model = Parse(maker);
    EXPECT_EQ(model.materials.at(0).texture, -1);
    ASSERT_EQ(model.notes.size(), 1U);
    EXPECT_NE(model.notes[0].find("Basis"), std::string::npos) << model.notes[0];
  }
  const GltfModel direct = Parse(TexturedTriangle(broken, "image/x-basis"));
  EXPECT_EQ(direct.materials.at(0).texture, -1);
  EXPECT_EQ(direct.notes.size(), 1U);
}

TEST(GltfReader, ErrorsNameTheFileTheNodeAndTheAccessor) {
  GlbMaker short_view;
  short_view.AddMesh({{"attributes", {{"POSITION", short_view.Positions(SquareCorners())}}}});
  short_view.json["accessors"][0]["count"] = 5;
  EXPECT_EQ(ErrorOf(short_view), "test.glb: node 0: accessor 0: reaches beyond its buffer view");

  GlbMaker bad_index;
  const int position = bad_index.Positions(SquareCorners());
  const int indices =
      bad_index.Accessor(std::vector<std::uint8_t>{0, 1, 9}, GlbMaker::kByte, "SCALAR", 1);
  bad_index.AddMesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  EXPECT_EQ(ErrorOf(bad_index), "test.glb: node 0: index 9 has no vertex");

  GlbMaker empty;
  empty.AddRoot(json::object({{"name", "nothing"}}));
  EXPECT_EQ(ErrorOf(empty), "test.glb: holds no triangles");
}

// The children of a file without scenes were drawn twice: below their parent, and as roots.
TEST(GltfReader, WithoutScenesEveryNodeIsDrawnOnce) {
  GlbMaker maker;
  const int position = maker.Positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.AddMesh({{"attributes", {{"POSITION", position}}}});
  maker.AddRoot({{"children", {0}}, {"translation", {5, 0, 0}}});
  maker.json.erase("scenes");
  maker.json.erase("scene");
  const GltfModel model = Parse(maker);
  ASSERT_EQ(model.mesh.triangles.size(), 1U);
  EXPECT_EQ(model.mesh.vertices[0].norm(), 5);
}

TEST(GltfReader, ACycleOfNodesIsAnError) {
  GlbMaker maker;
  maker.AddMesh({{"attributes", {{"POSITION", maker.Positions(SquareCorners())}}}});
  maker.json["nodes"][0]["children"] = {0};
  EXPECT_NE(ErrorOf(maker).find("below itself"), std::string::npos) << ErrorOf(maker);
}

TEST(GltfReader, AMissingFileIsNotFound) {
  const auto model = ReadGlb("/nonexistent/scene.glb");
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace crossnav::sim::test
