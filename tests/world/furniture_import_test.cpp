// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/furniture_import.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/models/obj_reader.h"
#include "support/temp_folder.h"
#include "support/zip_archive.h"

namespace crossnav::world {
namespace {

using test::Zip;

constexpr const char* kObj =
    "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 0 4\nv 0 0 4\nv 0 6 -1\nvt 0 0\n"
    "usemtl wood\nf 1/1 2/1 3/1 4/1\nusemtl glass\nf 1 2 5\nusemtl wood\nf -5 -4 -1\n";
constexpr const char* kMtl = "newmtl wood\nKd 1 0.5 0\nnewmtl glass\nKd 1 1 1\nd 0.05\n";

TEST(ObjReader, ReadsFacesMaterialsAndLeavesGlassOut) {
  const auto lookup = [](const std::string& name) -> std::optional<std::string> {
    if (name == "a.mtl") return kMtl;
    return std::nullopt;
  };
  const auto model = ParseObj(kObj, lookup, "a.obj");
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  EXPECT_EQ(model->mesh.triangles.size(), 3U);  // a quad and a triangle; the glass is gone
  ASSERT_EQ(model->materials.size(), 1U);
  EXPECT_EQ(model->materials[0].colour, (Rgb8{255, 128, 0}));
  const auto bad = ParseObj("v 0 0 0\nf 1 2 3\n", lookup, "bad.obj");
  ASSERT_FALSE(bad.has_value());
  EXPECT_EQ(bad.error().where, "bad.obj: line 2");
}

TEST(ObjReader, FacesOf60000CornersAreRefusedWithTheirLine) {
  const auto nothing = [](const std::string&) { return std::optional<std::string>(); };
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 60'000; ++i) text += " " + std::to_string(1 + i % 3);
  const auto large = ParseObj(text + "\n", nothing, "a.obj");
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().where, "a.obj: line 4");
  EXPECT_NE(large.error().what.find("1000 corners"), std::string::npos);
}

TEST(ObjReader, ManyFacesOfManyCornersAreRefusedBeforeTheyTakeMinutes) {
  const auto nothing = [](const std::string&) { return std::optional<std::string>(); };
  std::string text, face = "f";
  for (int i = 0; i < 900; ++i) {  // a comb: every other corner is no ear
    text += "v " + std::to_string(i) + " " + std::to_string(i % 2 == 0 ? 0 : 100 + i) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  for (int i = 0; i < 100; ++i) text += face + "\n";
  const auto model = ParseObj(text, nothing, "a.obj");
  ASSERT_FALSE(model);
  EXPECT_NE(model.error().what.find("too many faces of many corners"), std::string::npos);
}

TEST(ObjReader, ConcaveFacesKeepTheirHole) {
  // A door frame: one face with eight corners around an opening.
  const std::string frame =
      "v 0 0 0\nv 0 3 0\nv 3 3 0\nv 3 0 0\nv 2 0 0\nv 2 2 0\nv 1 2 0\nv 1 0 0\n"
      "f 1 2 3 4 5 6 7 8\n";
  const auto none = [](const std::string&) { return std::optional<std::string>(); };
  const auto model = ParseObj(frame, none, "frame.obj");
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  double area = 0;
  for (const auto& t : model->mesh.triangles) {
    const auto& p = model->mesh.vertices;
    area += 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
    const Vector3f center = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
    EXPECT_FALSE(center.x() > 1 && center.x() < 2 && center.y() < 2) << center.transpose();
  }
  EXPECT_NEAR(area, 7, 1e-5);
}

TEST(FurnitureImport, FitsTheCatalogueSizeAndKeepsTheCredits) {
  const test::TempFolder dir;
  const std::string catalogue =
      "version=1.0\nid#1=Scopia#bed1\nname#1=Bed\ncreator#1=Jos\\u00e9\nmodel#1=/m/a.obj\n"
      "width#1=170\ndepth#1=210\nheight#1=110\ndropOnTopElevation#1=-1\n"
      "id#2=Scopia#unknown\nname#2=Thing\nmodel#2=/m/a.obj\n";
  std::ofstream(dir.path() / "Scopia.sh3f", std::ios::binary) << Zip(
      {{"PluginFurnitureCatalog.properties", catalogue}, {"m/a.obj", kObj}, {"m/a.mtl", kMtl}});
  const auto report = ImportFurniture(dir.path(), dir.path() / "pack");
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_EQ(report->models, 1);
  const auto pack = FurniturePack::Load(dir.path() / "pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().Message();
  ASSERT_EQ(pack->entries().size(), 1U);
  const PackEntry& entry = pack->entries()[0];
  EXPECT_EQ(entry.kind, "bed");
  EXPECT_EQ(entry.licence, "CC-BY 3.0");
  EXPECT_EQ(entry.author, "Jos\xC3\xA9");
  const auto model = pack->Read(entry);
  ASSERT_TRUE(model.has_value()) << model.error().Message();
  EXPECT_TRUE(model->Size().isApprox(Vector3d(1.7, 2.1, 1.1), 1e-5)) << model->Size().transpose();
  EXPECT_NEAR(model->Bounds().min.z(), 0, 1e-6);
  std::ifstream credits(dir.path() / "pack" / "ATTRIBUTION.md");
  const std::string text((std::istreambuf_iterator<char>(credits)), {});
  EXPECT_NE(text.find("\"Bed\" (Scopia#bed1) by Jos"), std::string::npos);
  EXPECT_NE(text.find("creativecommons.org/licenses/by/3.0/"), std::string::npos);
}

TEST(FurnitureImport, ReadsTheCatalogueOfTheProgramItself) {
  const test::TempFolder dir;
  const std::string catalogue =
      "version=6.5\nid#1=eTeks#sofa\nname#1=Sofa\ncreator#1=eTeks\nmodel#1=/m/a.obj\n"
      "width#1=190\ndepth#1=90\nheight#1=80\n";
  std::ofstream(dir.path() / "sweethome3d.jar", std::ios::binary)
      << Zip({{"com/eteks/sweethome3d/io/DefaultFurnitureCatalog.properties", catalogue},
              {"m/a.obj", kObj},
              {"m/a.mtl", kMtl}});
  const auto report = ImportFurniture(dir.path() / "sweethome3d.jar", dir.path() / "pack");
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  const auto pack = FurniturePack::Load(dir.path() / "pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().Message();
  ASSERT_EQ(pack->entries().size(), 1U);
  EXPECT_EQ(pack->entries()[0].kind, "couch");
  EXPECT_EQ(pack->entries()[0].source, "sweethome3d.jar 6.5 of Debian's sweethome3d");
  EXPECT_EQ(pack->entries()[0].licence, "GNU GPL / CC-BY 3.0");
}

TEST(FurnitureImport, NamesMissingParts) {
  const test::TempFolder dir;
  EXPECT_EQ(ImportFurniture(dir.path(), dir.path() / "pack").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(FurniturePack::Load(dir.path()).error().code, ErrorCode::kNotFound);
}

TEST(FurniturePack, RefusesATruncatedPack) {
  const test::TempFolder dir;
  PackModel m;
  m.entry.id = "x";
  m.entry.kind = "chair";
  ModelBuilder b("chair");
  b.Colour({1, 2, 3});
  b.mesh.AddBox({0, 0, 0}, {1, 1, 1});
  m.model = b.Finish();
  ASSERT_TRUE(WritePack({m}, dir.path()).has_value());
  ASSERT_TRUE(FurniturePack::Load(dir.path()).has_value());
  std::filesystem::resize_file(dir.path() / "furniture.pack", 20);
  EXPECT_EQ(FurniturePack::Load(dir.path()).error().code, ErrorCode::kMismatch);
}

/// Regression: the padding of a material was written, too, so that equal packs had different
/// hashes.
TEST(FurniturePack, EqualModelsHaveEqualBytesWhateverTheMemoryHeldBefore) {
  const auto encoded = [](int before) {
    ObjectModel model;
    model.materials.resize(1);
    sim::Material& material = model.materials[0];
    std::memset(static_cast<void*>(&material), before, sizeof material);
    material.colour = {1, 2, 3};
    material.texture = -1;
    material.is_unlit = true;
    return EncodeModel(model);
  };
  EXPECT_EQ(encoded(0), encoded(0xAB));
  const auto read = DecodeModel(encoded(0xAB), {}, "pack");
  ASSERT_TRUE(read.has_value()) << read.error().Message();
  ASSERT_EQ(read->materials.size(), 1U);
  EXPECT_TRUE(read->materials[0].is_unlit);
  EXPECT_EQ(read->materials[0].colour.b, 3);
}

TEST(FurniturePack, KnowsAnotherPackFromItsOwnByTheHash) {
  const test::TempFolder dir;
  const auto write = [&](const std::string& name, std::uint8_t red) {
    PackModel m;
    m.entry.id = "x";
    m.entry.kind = "chair";
    ModelBuilder b("chair");
    b.Colour({red, 2, 3});
    b.mesh.AddBox({0, 0, 0}, {1, 1, 1});
    m.model = b.Finish();
    EXPECT_TRUE(WritePack({m}, dir.path() / name).has_value());
    return FurniturePack::Load(dir.path() / name)->hash();
  };
  const std::string red = write("red", 200);
  EXPECT_EQ(red, write("again", 200));
  EXPECT_NE(red, write("dark", 20));
  // An import that was interrupted: the new geometry under the old manifest.
  std::filesystem::copy_file(dir.path() / "dark/furniture.pack", dir.path() / "red/furniture.pack",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(FurniturePack::Load(dir.path() / "red").error().code, ErrorCode::kMismatch);
}

}  // namespace
}  // namespace crossnav::world
