// SPDX-License-Identifier: MIT
// Any bytes are safe to pass: these tests assert nothing but "comes back", and rely on sanitizers.
#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "crossnav/sim/scene/gltf_reader.h"
#include "crossnav/sim/scene/image_codec.h"
#include "glb_maker.h"
#include "support/png_bytes.h"

namespace crossnav::sim::test {
namespace {

/// A file that uses everything the reader reads.
std::vector<std::uint8_t> RichGlb() {
  GlbMaker maker;
  const int position = maker.Positions(SquareCorners());
  const int indices =
      maker.Accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, GlbMaker::kShort, "SCALAR", 1);
  const int colour =
      maker.Accessor(std::vector<std::uint8_t>(16, 200), GlbMaker::kByte, "VEC4", 4, true);
  const int uv =
      maker.Accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, GlbMaker::kFloat, "VEC2", 2);
  const int view = maker.View(crossnav::test::PngBytes(RgbImage(4, 4, {9, 8, 7})));
  maker.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  maker.json["textures"] = {{{"source", 0}}};
  maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  maker.AddMesh({{"attributes", {{"POSITION", position}, {"COLOR_0", colour}, {"TEXCOORD_0", uv}}},
                 {"indices", indices},
                 {"material", 0}},
                {{"translation", {1, 2, 3}}});
  return maker.Bytes();
}

/// The mesh holds together whatever came in.
void ExpectConsistent(const Result<GltfModel>& model) {
  if (!model) {
    EXPECT_FALSE(model.error().what.empty());
    EXPECT_EQ(model.error().where.rfind("hostile.glb", 0), 0U);
    return;
  }
  const TriangleMesh& mesh = model->mesh;
  EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size());
  EXPECT_TRUE(mesh.vertex_colours.empty() || mesh.vertex_colours.size() == mesh.vertices.size());
  ASSERT_EQ(mesh.triangle_material.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) ASSERT_LT(v, mesh.vertices.size());
    const Material& material = model->materials.at(mesh.triangle_material[t]);
    ASSERT_LT(material.texture, static_cast<int>(model->textures.size()));
  }
  for (const Vector3f& v : mesh.vertices) ASSERT_TRUE(v.allFinite());
}

TEST(HostileGltf, TheIntactFileIsRead) {
  const auto bytes = RichGlb();
  const auto model = ParseGlb(bytes, "hostile.glb", {});
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  EXPECT_EQ(model->mesh.triangles.size(), 2U);
  EXPECT_EQ(model->textures.size(), 1U);
}

TEST(HostileGltf, EveryTruncationIsRefusedOrConsistent) {
  const auto bytes = RichGlb();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // Copied, so that a sanitizer sees the first byte read behind the end.
    const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<long>(size));
    ExpectConsistent(ParseGlb(cut, "hostile.glb", {}));
  }
}

TEST(HostileGltf, NodesThatShareTheirChildrenAreRefused) {
  GlbMaker maker;
  maker.AddMesh({{"attributes", {{"POSITION", maker.Positions(SquareCorners())}}}});
  for (int i = 0; i < 40; ++i) maker.json["nodes"].push_back({{"children", {i, i}}});
  maker.json["scenes"][0]["nodes"] = {40};
  const auto bytes = maker.Bytes();
  const auto model = ParseGlb(bytes, "hostile.glb", {});
  ASSERT_FALSE(model.has_value());
  EXPECT_NE(model.error().what.find("hangs in two places"), std::string::npos)
      << model.error().what;
}

TEST(HostileGltf, ASmallFileThatDrawsItsMeshEverywhereIsRefused) {
  GlbMaker maker;
  const int position = maker.Positions(std::vector<float>(std::size_t{3} * 10'000, 0.5F));
  maker.AddMesh({{"attributes", {{"POSITION", position}}}});
  nlohmann::json children = nlohmann::json::array();
  for (int i = 0; i < 1000; ++i) {
    maker.json["nodes"].push_back({{"mesh", 0}});
    children.push_back(i + 1);
  }
  maker.json["nodes"].push_back({{"children", children}});
  maker.json["scenes"][0]["nodes"] = {1001};
  const auto bytes = maker.Bytes();
  const auto model = ParseGlb(bytes, "hostile.glb", {});
  ASSERT_FALSE(model.has_value());
  EXPECT_NE(model.error().what.find("draws more than 2000000"), std::string::npos)
      << model.error().what;
}

TEST(HostileGltf, APngThatClaimsMorePixelsThanItsBytesCanHoldIsRefused) {
  std::vector<std::uint8_t> png = crossnav::test::PngBytes(RgbImage(4, 4));
  for (const std::size_t side : {16U, 20U}) {  // width and height, big-endian
    png[side] = 0;
    png[side + 1] = 0;
    png[side + 2] = 0x1F;
  }
  // The checksum of the header, so that only the size is wrong.
  std::uint32_t crc = ~0U;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= png[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  for (std::size_t i = 0; i < 4; ++i) png[29 + i] = static_cast<std::uint8_t>(~crc >> (24 - 8 * i));
  const auto image = DecodeImage(png, "a.png");
  ASSERT_FALSE(image.has_value());
  EXPECT_NE(image.error().what.find("more pixels than its bytes"), std::string::npos)
      << image.error().what;
}

TEST(HostileGltf, FlippedBytesAreRefusedOrConsistent) {
  const auto intact = RichGlb();
  Rng rng(7);
  for (int round = 0; round < 4000; ++round) {
    auto bytes = intact;
    for (int flips = 1 + static_cast<int>(rng.Below(4)); flips > 0; --flips) {
      bytes[rng.Below(static_cast<std::uint32_t>(bytes.size()))] =
          static_cast<std::uint8_t>(rng.Next());
    }
    ExpectConsistent(ParseGlb(bytes, "hostile.glb", {}));
  }
}

TEST(HostileGltf, EveryNumberOfTheJsonReplacedByAnExtremeOneIsRefusedOrConsistent) {
  const auto bytes = RichGlb();
  const std::string text(bytes.begin(), bytes.end());
  const std::size_t end = text.find("\"scenes\"");
  ASSERT_NE(end, std::string::npos);
  for (std::size_t at = 20; at < end; ++at) {
    if (std::isdigit(static_cast<unsigned char>(text[at])) == 0) continue;
    std::size_t stop = at;
    while (std::isdigit(static_cast<unsigned char>(text[stop])) != 0) ++stop;
    for (const char* number : {"-1", "4294967295", "9223372036854775807", "0", "1e30"}) {
      std::string chunk = text.substr(20, at - 20) + number;
      const std::size_t json_size = bytes[12] | bytes[13] << 8;
      chunk += text.substr(stop, 20 + json_size - stop);
      while (chunk.size() % 4 != 0) chunk += ' ';
      std::vector<std::uint8_t> glb(bytes.begin(), bytes.begin() + 12);
      const auto word = [&glb](std::size_t w) {
        for (int i = 0; i < 4; ++i) glb.push_back(static_cast<std::uint8_t>(w >> (8 * i)));
      };
      word(chunk.size());
      word(0x4E4F534A);
      glb.insert(glb.end(), chunk.begin(), chunk.end());
      glb.insert(glb.end(), bytes.begin() + 20 + static_cast<long>(json_size), bytes.end());
      for (int i = 0; i < 4; ++i)
        glb[8 + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(glb.size() >> (8 * i));
      ExpectConsistent(ParseGlb(glb, "hostile.glb", {}));
    }
    at = stop;
  }
}

}  // namespace
}  // namespace crossnav::sim::test
