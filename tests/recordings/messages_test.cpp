// SPDX-License-Identifier: MIT
// CDR and its messages: both byte orders, and truncation at every length.
#include "crossnav/recordings/ros_messages.h"

#include <gtest/gtest.h>

#include <functional>

#include "crossnav/recordings/image_pairs.h"
#include "crossnav/recordings/ros_images.h"
#include "crossnav/recordings/text_rows.h"
#include "recordings/cdr_writer.h"

namespace crossnav::recordings {
namespace {

using testing::ImageToWrite;

ImageToWrite Depth2x2(bool is_big) {
  // Rows of three pixels, of which two are the image.
  const std::string data =
      is_big ? std::string("\0\1\0\2zz\0\3\0\4zz", 12) : std::string("\1\0\2\0zz\3\0\4\0zz", 12);
  return {5'000'000'007, "cam", "16UC1", 2, 2, 6, data, is_big};
}

TEST(RosMessages, AnImageIsReadInBothByteOrders) {
  for (const bool is_big : {false, true}) {
    const std::string message = testing::ImageMessage(Depth2x2(is_big));
    const auto image = ReadRosImage(message);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->header.time_ns, 5'000'000'007);
    EXPECT_EQ(image->header.frame, "cam");
    const auto depth_m = DepthOf(*image, 0.001, "here");
    ASSERT_TRUE(depth_m) << depth_m.error().Message();
    for (int i = 0; i < 4; ++i)
      EXPECT_FLOAT_EQ(depth_m->data[static_cast<std::size_t>(i)], 0.001F * (i + 1)) << is_big;
  }
}

TEST(RosMessages, NoneIsReadWhenItIsCutShort) {
  const testing::SevenNumbers pose = {1, 2, 3, 0, 0, 0, 1};
  const std::string image = testing::ImageMessage(Depth2x2(false));
  const std::string packed = testing::CompressedMessage(1, "cam", "png", "data");
  const std::string camera = testing::CameraMessage({"cam", "plumb_bob", 4, 3, 0, {1, 2}, 5});
  const std::string transform = testing::TransformMessage(1, "a", "b", pose);
  const std::string odometry = testing::OdometryMessage(1, "a", "b", pose);
  const auto count = [](const std::string& whole,
                        const std::function<bool(std::string_view)>& read) {
    std::size_t most = 0;
    for (std::size_t n = 0; n < whole.size(); ++n)
      if (!read(std::string_view(whole).substr(0, n))) most = n;
    EXPECT_TRUE(read(whole));
    return most;
  };
  EXPECT_EQ(count(image, [](auto m) { return ReadRosImage(m).has_value(); }), image.size() - 1);
  EXPECT_EQ(count(packed, [](auto m) { return ReadRosCompressedImage(m).has_value(); }),
            packed.size() - 1);
  EXPECT_EQ(count(camera, [](auto m) { return ReadRosCameraInfo(m).has_value(); }),
            camera.size() - 2)
      << "all but a flag that is not used";
  EXPECT_EQ(count(transform, [](auto m) { return ReadRosTransforms(m).has_value(); }),
            transform.size() - 1);
  EXPECT_EQ(count(odometry, [](auto m) { return ReadRosOdometry(m).has_value(); }),
            odometry.size() - 8 * 78 - 1)
      << "all but covariances and speeds, which are not used";
}

TEST(RosMessages, CountsThatLieAreRefused) {
  std::string message = testing::CdrWriter().Number(0xFFFFFFFFU).Take();
  EXPECT_FALSE(ReadRosTransforms(message));
  message = testing::CdrWriter().Header(0, "c").Text("png").Number(0x7FFFFFFFU).Take();
  EXPECT_FALSE(ReadRosCompressedImage(message));
  EXPECT_FALSE(ReadRosHeader(std::string("\0\2\0\0aaaaaaaaaaaaaaaa", 20))) << "a parameter list";
  EXPECT_FALSE(ReadRosHeader(""));
}

TEST(RosMessages, ATransformIsReadUnchanged) {
  const auto read = ReadRosTransforms(
      testing::TransformMessage(3, "/odom", "base", {1, 2, 3, 0.5, 0.5, 0.5, 0.5}));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ((*read)[0].header.frame, "odom");
  EXPECT_EQ((*read)[0].child, "base");
  EXPECT_EQ((*read)[0].p, Vector3d(1, 2, 3));
  EXPECT_EQ((*read)[0].q.w(), 0.5);
}

TEST(RosImages, ColoursLieAsTheEncodingSays) {
  RosImage image;
  image.width_px = image.height_px = 1;
  image.row_bytes = 4;
  image.data = "\x01\x02\x03\x04";
  const auto colour = [&](const char* encoding) {
    image.encoding = encoding;
    const auto rgb = ColourOf(image, "here");
    return rgb ? rgb->At(0, 0) : Rgb8{};
  };
  EXPECT_EQ(colour("rgb8"), (Rgb8{1, 2, 3}));
  EXPECT_EQ(colour("bgra8"), (Rgb8{3, 2, 1}));
  EXPECT_EQ(colour("mono8"), (Rgb8{1, 1, 1}));
  image.encoding = "bayer_rggb8";
  const auto bayer = ColourOf(image, "here");
  ASSERT_FALSE(bayer);
  EXPECT_EQ(bayer.error().Message(), "here: colour of encoding \"bayer_rggb8\" is not read");
}

TEST(RosImages, SizesThatDoNotFitAreErrors) {
  RosImage image;
  image.encoding = "16UC1";
  image.data = "123456";
  image.width_px = 2;
  image.height_px = 2;
  image.row_bytes = 4;
  EXPECT_FALSE(DepthOf(image, 0.001, "here")) << "two bytes short";
  image.row_bytes = 3;
  EXPECT_FALSE(DepthOf(image, 0.001, "here")) << "rows shorter than the width";
  image.width_px = 100000;
  EXPECT_FALSE(DepthOf(image, 0.001, "here"));
  image.width_px = 0;
  EXPECT_FALSE(DepthOf(image, 0.001, "here")) << "no PNG";
}

HeldImage At(std::int64_t time_ns) {
  return {time_ns, std::to_string(time_ns), ""};
}

TEST(ImagePairs, EachDepthImageGetsTheNearestColourWithinTheTolerance) {
  ImagePairs pairs(10);
  pairs.AddDepth(At(100));
  EXPECT_FALSE(pairs.Take(false)) << "a better one may come";
  pairs.AddColour(At(92));
  EXPECT_FALSE(pairs.Take(false));
  pairs.AddColour(At(104));
  auto pair = pairs.Take(false);
  ASSERT_TRUE(pair && pair->colour);
  EXPECT_EQ(pair->colour->time_ns, 104);
  pairs.AddDepth(At(112));  // a slow colour camera: the same one again
  pairs.AddDepth(At(130));
  pair = pairs.Take(true);
  ASSERT_TRUE(pair && pair->colour);
  EXPECT_EQ(pair->colour->time_ns, 104);
  pair = pairs.Take(true);
  ASSERT_TRUE(pair);
  EXPECT_FALSE(pair->colour);
  EXPECT_FALSE(pairs.Take(true));
}

TEST(ImagePairs, HoldsAFewImagesOnly) {
  ImagePairs pairs(10);
  int taken = 0;
  for (int i = 0; i < 1000; ++i) {
    pairs.AddDepth(At(i));
    while (pairs.Take(false)) ++taken;
  }
  EXPECT_GT(taken, 950);
}

TEST(TextRows, TimesKeepTheirNanoseconds) {
  EXPECT_EQ(TimeOf("1305031102.175304"), 1305031102175304000);
  EXPECT_EQ(TimeOf("0.1234567891"), 123456789);
  EXPECT_EQ(TimeOf("7"), 7000000000);
  for (const char* bad : {"", "x", "-1", "1.x", "99999999999", "1e5"})
    EXPECT_FALSE(TimeOf(bad)) << bad;
}

TEST(TextRows, AreWordsWithoutComments) {
  const auto rows = RowsOf("# head\r\n\n a  b\tc\r\nd\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].line, 3);
  EXPECT_EQ(rows[0].words, (std::vector<std::string_view>{"a", "b", "c"}));
  EXPECT_TRUE(std::isnan(*NumberOf("-1.#IND")));
  EXPECT_TRUE(std::isnan(*NumberOf("nan")));
  EXPECT_EQ(NumberOf("-2.5e-1"), -0.25);
  EXPECT_FALSE(NumberOf("1.0x"));
}

}  // namespace
}  // namespace crossnav::recordings
