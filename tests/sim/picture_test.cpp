// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "crossnav/sim/scene/image_codec.h"
#include "micro_scene.h"
#include "support/png_bytes.h"
#include "support/temp_folder.h"

namespace crossnav::sim::test {
namespace {

TEST(Picture, PngsReadBackAsTheyWere) {
  Rng rng(2);
  RgbImage image(37, 23);
  for (Rgb8& p : image.data) {
    p = {static_cast<std::uint8_t>(rng.Next()), static_cast<std::uint8_t>(rng.Next()),
         static_cast<std::uint8_t>(rng.Next())};
  }
  const crossnav::test::TempFolder temp;
  const auto file = temp.path() / "p.png";
  ASSERT_TRUE(WritePng(image, file).has_value());
  std::ifstream stream(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(stream), {});
  const auto back = DecodeImage(bytes, "p.png");
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->rgb.data, image.data);
  EXPECT_EQ(back->rgb.width, 37);
  // Nothing but the picture is left behind.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(temp.path()), {}), 1);
}

TEST(Picture, AnUnwritablePictureIsAnError) {
  EXPECT_EQ(WritePng(RgbImage(2, 2), "/nonexistent/p.png").error().code, ErrorCode::kIo);
  EXPECT_EQ(WritePng(RgbImage(), "p.png").error().code, ErrorCode::kInvalid);
}

TEST(Picture, BrokenImagesAreErrors) {
  auto bytes = crossnav::test::PngBytes(RgbImage(8, 8, {1, 2, 3}));
  bytes.resize(bytes.size() / 2);
  EXPECT_FALSE(DecodeImage(bytes, "x").has_value());
  EXPECT_FALSE(
      DecodeImage(std::vector<std::uint8_t>{0xFF, 0xD8, 0xFF, 0xE0, 1, 2}, "x").has_value());
  EXPECT_EQ(DecodeImage({}, "x").error().code, ErrorCode::kUnsupported);
}

TEST(Picture, DepthIsBlackWhereThereIsNoneAndDarkensWithDistance) {
  DepthImage depth(4, 1);
  depth.data = {0, NAN, 1, 9};
  const RgbImage picture = ColourDepth(depth);
  EXPECT_EQ(picture.data[0], Rgb8{});
  EXPECT_EQ(picture.data[1], Rgb8{});
  EXPECT_GT(picture.data[2].r, picture.data[3].r);
}

TEST(Picture, InstancesHaveStableDifferentColours) {
  InstanceImage instance(4, 1);
  instance.data = {0, 1, 2, 1};
  const RgbImage picture = ColourInstances(instance);
  EXPECT_EQ(picture.data[0], Rgb8{});
  EXPECT_EQ(picture.data[1], picture.data[3]);
  EXPECT_NE(picture.data[1], picture.data[2]);
}

TEST(Picture, TheTopDownViewShowsFurnitureUnderTheCeilingWithXUpAndYLeft) {
  MicroScene m;
  m.Room(0, 0, 6, 4);
  m.scene().materials = {Material{{220, 220, 220}, -1}, Material{{200, 20, 20}, -1}};
  m.SetMaterial(1);
  m.Begin("table");
  m.Box({4.5, 0.5, 0}, {5.5, 1.5, 0.75});  // large x (up), small y (right)
  const Scene scene = m.Finish();
  const RayCaster caster(scene);
  const auto navmesh = NavMesh::Build(scene, {});
  const TopDown view = RenderTopDown(scene, caster, *navmesh, 0, 20);
  const auto at = [&view](double x, double y) {
    const Vector3d p(x, y, 0);
    return view.image.At(static_cast<int>(std::lround(view.U(p))),
                         static_cast<int>(std::lround(view.V(p))));
  };
  EXPECT_GT(at(5, 1).r, 2 * at(5, 1).g);            // the table
  EXPECT_GT(at(2, 2).g, at(2, 2).r);                // walkable ground is tinted green
  EXPECT_LT(view.V({5, 1, 0}), view.V({1, 1, 0}));  // +x is up
  EXPECT_GT(view.U({5, 1, 0}), view.U({5, 3, 0}));  // +y is left
}

}  // namespace
}  // namespace crossnav::sim::test
