// SPDX-License-Identifier: MIT
// Depth files, lenses and registration.
#include <gtest/gtest.h>

#include "crossnav/core/png_image.h"
#include "crossnav/core/rng.h"
#include "crossnav/recordings/depth_image.h"
#include "crossnav/recordings/frames.h"
#include "recordings/wall_drive.h"
#include "support/temp_folder.h"

namespace crossnav::recordings {
namespace {

using testing::ExpectFlat;

TEST(DepthImage, PngOf16BitsComesBackAndEveryTearIsAnError) {
  const test::TempFolder folder;
  Rng rng(1);
  Image<std::uint16_t> image(13, 7);
  for (auto& value : image.data) value = static_cast<std::uint16_t>(rng.Below(65536));
  testing::WritePng16(folder.path() / "d.png", image);
  const std::string bytes = test::ReadText(folder.path() / "d.png");
  const auto back = DecodeDepth16(BytesOf(bytes), "d.png");
  ASSERT_TRUE(back) << back.error().Message();
  EXPECT_EQ(back->data, image.data);
  for (std::size_t n = 0; n + 12 < bytes.size(); ++n) {  // but for the mark of the end
    const auto torn = DecodeDepth16(BytesOf(std::string_view(bytes).substr(0, n)), "d.png");
    ASSERT_FALSE(torn) << n;
    EXPECT_EQ(torn.error().where, "d.png");
  }
}

TEST(DepthImage, PgmOf16BitsHasTheHighByteFirst) {
  const std::string pgm("P5 2 1 65535\n\x01\x02\xff\xff", 17);
  const auto image = DecodeDepth16(BytesOf(pgm), "d.pgm");
  ASSERT_TRUE(image) << image.error().Message();
  EXPECT_EQ(image->At(0, 0), 0x0102);
  const DepthImage depth_m = DepthOf(*image, 0.001);
  EXPECT_FLOAT_EQ(depth_m.At(0, 0), 0.258F);
  EXPECT_EQ(depth_m.At(1, 0), 0) << "65535 is what lost depth is called";
  EXPECT_FALSE(DecodeDepth16(BytesOf(pgm.substr(0, 16)), "d.pgm"));
  for (const char* bad : {"P5 2 1 255\nab", "P5", "P5 2 1 65535", "P5 2 -1 65535\nabcd",
                          "P5 99999999999 1 65535\nabcd", "P5 4294967298 1 65535\nabcd"})
    EXPECT_FALSE(DecodeDepth16(BytesOf(bad), "d.pgm")) << bad;
  EXPECT_FALSE(DecodeDepth16(BytesOf("GIF89a"), "d.gif"));
}

TEST(DepthImage, AColourPngIsNoDepth) {
  const std::string png = EncodePng(testing::Gradient(4, 4));
  const auto image = DecodePng16(BytesOf(png), kMostSide_px, "c.png");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::kUnsupported);
}

CameraIntrinsics Pinholes(int width, int height) {
  return IntrinsicsFromHfov(width, height, 1.2);
}

TEST(Registration, TheSameCameraGivesTheSameImage) {
  Rng rng(2);
  DepthImage depth_m(20, 15);
  for (float& d : depth_m.data) d = static_cast<float>(rng.Uniform(0.0, 4.0));
  const DepthImage out =
      RegisterDepth(depth_m, Pinholes(20, 15), Pinholes(20, 15), Pose::Identity());
  EXPECT_EQ(out.data, depth_m.data);
}

TEST(Registration, ALargerColourImageHasNoHolesInAWall) {
  const DepthImage depth_m(20, 15, 2.0F);
  ExpectFlat(RegisterDepth(depth_m, Pinholes(20, 15), Pinholes(67, 50), Pose::Identity()), 2.0);
}

TEST(Registration, DepthIsThatOfTheColourCameraAndShiftsByTheBaseline) {
  const CameraIntrinsics K = Pinholes(40, 30);
  DepthImage depth_m(40, 30);
  depth_m.At(20, 10) = 2.0F;
  Pose T_colour_depth = Pose::Identity();
  T_colour_depth.translation() = Vector3d(0.1, 0, 0.5);
  const DepthImage out = RegisterDepth(depth_m, K, K, T_colour_depth);
  const Vector3d p = T_colour_depth * BackProjectPixel(K, 20, 10, 2.0);
  const int u = static_cast<int>(std::lround(K.fx * p.x() / p.z() + K.cx));
  const int v = static_cast<int>(std::lround(K.fy * p.y() / p.z() + K.cy));
  EXPECT_FLOAT_EQ(out.At(u, v), 2.5F);
  EXPECT_EQ(std::count_if(out.data.begin(), out.data.end(), [](float d) { return d > 0; }), 1);
}

TEST(Registration, TheNearestSurfaceWins) {
  const CameraIntrinsics K = Pinholes(40, 30);
  DepthImage depth_m(40, 30, 4.0F);
  for (int v = 0; v < 30; ++v) depth_m.At(19, v) = depth_m.At(20, v) = 1.0F;  // a post
  Pose T_colour_depth = Pose::Identity();
  T_colour_depth.translation().x() = 0.2;
  const DepthImage out = RegisterDepth(depth_m, K, K, T_colour_depth);
  const int shift = static_cast<int>(std::lround(K.fx * 0.2 / 1.0));
  EXPECT_FLOAT_EQ(out.At(20 + shift, 15), 1.0F);
}

TEST(Registration, PointsBehindTheCameraAndNansAreLeftOut) {
  DepthImage depth_m(8, 6, 1.0F);
  depth_m.At(0, 0) = std::numeric_limits<float>::infinity();
  depth_m.At(1, 0) = std::numeric_limits<float>::quiet_NaN();
  depth_m.At(2, 0) = -1.0F;
  Pose back = Pose::Identity();
  back.translation().z() = -2;
  ExpectFlat(RegisterDepth(depth_m, Pinholes(8, 6), Pinholes(9, 6), back), 0.0);
}

TEST(Registration, ALensIsTakenOut) {
  CameraModel camera{Pinholes(80, 60), {0.1, -0.05, 0.001, -0.002, 0.01, 0, 0, 0}};
  // The literal formula of Brown and Conrady, for one point.
  const double x = 0.4, y = -0.3, r2 = x * x + y * y;
  const double radial = 1 + 0.1 * r2 - 0.05 * r2 * r2 + 0.01 * r2 * r2 * r2;
  const double xd = x * radial + 2 * 0.001 * x * y - 0.002 * (r2 + 2 * x * x);
  const double yd = y * radial + 0.001 * (r2 + 2 * y * y) - 2 * 0.002 * x * y;
  const CameraIntrinsics& K = camera.K;
  DepthImage seen(80, 60);
  const auto px = [](double focal, double at, double centre) {
    return static_cast<int>(std::lround(focal * at + centre));
  };
  seen.At(px(K.fx, xd, K.cx), px(K.fy, yd, K.cy)) = 3.0F;
  const DepthImage out = Rectify(seen, camera);
  bool is_there = false;  // within the pixel that rounding may cost
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      is_there = is_there || out.At(px(K.fx, x, K.cx) + du, px(K.fy, y, K.cy) + dv) == 3.0F;
  EXPECT_TRUE(is_there);
  camera.distortion = {};
  EXPECT_EQ(Rectify(seen, camera).data, seen.data);
}

}  // namespace
}  // namespace crossnav::recordings
