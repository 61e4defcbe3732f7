// SPDX-License-Identifier: MIT
// ROS 2 bags: two written by the package rosbags (data/, make_bags.py), and synthetic bags with
// faults.
#include <gtest/gtest.h>

#include <functional>

#include "recordings/cdr_writer.h"
#include "recordings/wall_drive.h"
#include "support/places.h"
#include "support/temp_folder.h"

namespace crossnav::recordings {
namespace {

using testing::BagMaker;
using testing::ExpectError;
using testing::ExpectFlat;
using testing::ReadAll;
using testing::ReadResult;

const std::filesystem::path kData = test::SourcePath("tests/recordings/data");

TEST(RosbagsBag, RawImagesAreMatchedRegisteredInterpolatedAndCounted) {
  const ReadResult result = ReadAll(kData / "raw");
  ASSERT_TRUE(result.recording) << result.error();
  const RecordingCounts& counts = result.recording->counts;
  EXPECT_EQ(counts.depth_images, 21);
  EXPECT_EQ(counts.without_pose, 1);
  EXPECT_EQ(counts.without_colour, 1);
  EXPECT_EQ(counts.jumps, 1);
  ASSERT_EQ(counts.frames, 18);
  ASSERT_EQ(result.frames.size(), 18U);
  const Observation& first = result.frames[0].obs;
  EXPECT_EQ(first.time_ns, 100'050'000'000);
  // Halfway between two poses of the robot; the colour camera is 0.06 m to its right, 1 m up.
  EXPECT_TRUE(first.T_world_camera.translation().isApprox(Vector3d(0.025, -0.06, 1), 1e-9));
  EXPECT_TRUE(first.T_world_camera.linear().col(2).isApprox(Vector3d::UnitX(), 1e-9));
  EXPECT_EQ(first.camera.width_px, 48);
  EXPECT_EQ(first.camera.fx, 40);
  EXPECT_EQ(first.rgb.data, testing::Gradient(48, 36).data);
  EXPECT_EQ(first.depth_m.width, 48);
  ExpectFlat(first.depth_m, 2.975, 6e-4);
  EXPECT_NEAR(result.frames[17].obs.T_world_camera.translation().y(), 2 - 0.06, 1e-9);
  EXPECT_GT(result.frames[17].share_done, 0);
}

TEST(RosbagsBag, PackedImagesAndTransformsAloneWillDo) {
  for (const char* path : {"packed", "packed/packed.mcap"}) {
    const ReadResult result = ReadAll(kData / path);
    ASSERT_TRUE(result.recording) << result.error();
    ASSERT_EQ(result.frames.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      const Observation& obs = result.frames[i].obs;
      EXPECT_TRUE(obs.T_world_camera.translation().isApprox(Vector3d(0.05 * i, 0, 1), 1e-9));
      ExpectFlat(obs.depth_m, 3.0 - 0.05 * static_cast<double>(i), 1e-6);
      EXPECT_NEAR(obs.rgb.At(12, 9).r, 60, 8) << "JPEG";
    }
  }
}

TEST(RosbagsBag, EveryTearIsAnErrorThatNamesTheByteAndTheRemedy) {
  const test::TempFolder folder;
  const auto path = folder.path() / "torn.mcap";
  const std::string bytes = test::ReadText(kData / "packed/packed.mcap");
  for (std::size_t n = 0; n < bytes.size() - 1; n += 97) {
    test::WriteText(path, bytes.substr(0, n));
    const ReadResult result = ReadAll(path);
    ASSERT_FALSE(result.recording) << n;
    EXPECT_NE(result.error().find("torn.mcap"), std::string::npos) << result.error();
    EXPECT_TRUE(result.frames.empty());
  }
  ExpectError(ReadAll(path), {"cut off behind byte", "--skip-damaged"});
  RecordingOptions options;
  options.skip_damaged = true;
  const ReadResult result = ReadAll(path, options);
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_TRUE(result.recording->counts.is_torn);
  EXPECT_EQ(result.recording->counts.frames, 5);
}

TEST(RosbagsBag, DamageAnywhereEndsInAnErrorOrLeavesValidFrames) {
  const test::TempFolder folder;
  const auto path = folder.path() / "bad.mcap";
  const std::string bytes = test::ReadText(kData / "raw/raw.mcap");
  int errors = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 61) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x40);
    test::WriteText(path, damaged);
    const ReadResult result = ReadAll(path);
    if (!result.recording) ++errors;
    for (const RecordedFrame& frame : result.frames)
      ASSERT_TRUE(IsValidPose(frame.obs.T_world_camera));
  }
  EXPECT_GT(errors, 10) << "texts of types and the index are not looked at";
}

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Bags of three depth images and further messages of a test.
class MadeBag : public ::testing::Test {
 protected:
  static constexpr testing::SevenNumbers kLevel = {0, 0, 0, 0, 0, 0, 1};

  static std::int64_t Time(int i) { return kSecond_ns + i * kSecond_ns / 10; }

  void AddDepth(const std::string& topic, const std::string& frame, float depth_m = 2.0F) {
    std::string data;
    for (int i = 0; i < 8 * 6; ++i)
      data.append(reinterpret_cast<const char*>(&depth_m), sizeof depth_m);
    for (int i = 0; i < 3; ++i)
      bag_.Add(topic, "sensor_msgs/msg/Image", Time(i),
               testing::ImageMessage({Time(i), frame, "32FC1", 8, 6, 32, data, false}));
  }
  void AddColour(const std::string& topic, const std::string& frame,
                 const std::string& encoding = "bgr8") {
    for (int i = 0; i < 3; ++i)
      bag_.Add(topic, "sensor_msgs/msg/Image", Time(i),
               testing::ImageMessage(
                   {Time(i), frame, encoding, 8, 6, 24, std::string(8 * 6 * 3, 'x'), false}));
  }
  void AddInfo(const std::string& topic, const testing::CameraToWrite& camera) {
    bag_.Add(topic, "sensor_msgs/msg/CameraInfo", kSecond_ns, testing::CameraMessage(camera));
  }
  void AddOdometry(const std::string& topic, const std::string& child) {
    for (int i = 0; i < 3; ++i)
      bag_.Add(topic, "nav_msgs/msg/Odometry", Time(i),
               testing::OdometryMessage(Time(i), "odom", child, {0.1 * i, 0, 0, 0, 0, 0, 1}));
  }
  void AddStatic(const std::string& parent, const std::string& child,
                 const testing::SevenNumbers& pose) {
    bag_.Add("/tf_static", "tf2_msgs/msg/TFMessage", kSecond_ns,
             testing::TransformMessage(0, parent, child, pose));
  }
  /// Depth alone, whose poses are the camera's.
  void AddSimple() {
    AddDepth("/depth/image", "cam");
    AddInfo("/depth/camera_info", {"cam", "", 8, 6, 0, {}, 6.0});
    AddOdometry("/odom", "cam");
  }
  ReadResult Read(const RecordingOptions& options = {}, const std::string& encoding = "cdr") {
    bag_.Write(folder_.path() / "made.mcap", encoding);
    return ReadAll(folder_.path() / "made.mcap", options);
  }

  BagMaker bag_;
  test::TempFolder folder_;
};

TEST_F(MadeBag, WithoutColourHasTheDepthCamerasGrid) {
  AddSimple();
  const ReadResult result = Read();
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_FALSE(result.recording->has_colour);
  ASSERT_EQ(result.frames.size(), 3U);
  EXPECT_EQ(result.frames[2].obs.T_world_camera.translation(), Vector3d(0.2, 0, 0));
  ExpectFlat(result.frames[0].obs.depth_m, 2.0, 0);
  EXPECT_EQ(result.frames[0].obs.rgb.width, 8);
}

TEST_F(MadeBag, InAFolderNeedsNoMetadata) {
  AddSimple();
  std::filesystem::create_directories(folder_.path() / "bag");
  bag_.Write(folder_.path() / "bag/b_1.mcap");
  bag_.Write(folder_.path() / "bag/b_0.mcap");
  const ReadResult result = ReadAll(folder_.path() / "bag");
  ASSERT_TRUE(result.recording) << result.error();
  test::WriteText(folder_.path() / "bag/metadata.yaml", "a:\n  storage_identifier: sqlite3\n");
  ExpectError(ReadAll(folder_.path() / "bag"), {"metadata.yaml", "sqlite3", "ros2 bag convert"});
  test::WriteText(folder_.path() / "bag/metadata.yaml",
                  "a:\n  compression_mode: FILE\n  storage_identifier: mcap\n");
  ExpectError(ReadAll(folder_.path() / "bag"), {"compression_mode", "FILE"});
  test::WriteText(folder_.path() / "bag/metadata.yaml",
                  "a:\n  relative_file_paths:\n  - \"gone.mcap\"\n  storage_identifier: mcap\n");
  ExpectError(ReadAll(folder_.path() / "bag"), {"gone.mcap", "cannot be opened"});
}

TEST_F(MadeBag, NamesTheMissingPartAndTheRemedy) {
  AddColour("/rgb/image", "cam");
  ExpectError(Read(), {"made.mcap", "no depth images", "/rgb/image"});
  AddDepth("/depth/image", "cam");
  ExpectError(Read(), {"no sensor_msgs/CameraInfo for /depth/image", "--intrinsics"});
  AddInfo("/depth/camera_info", {"cam", "", 8, 6, 0, {}, 6.0});
  ExpectError(Read(), {"no poses", "\"cam\"", "nav_msgs/Odometry"});
  AddOdometry("/odom", "base");
  ExpectError(Read(), {"no transform between \"base\"", "\"cam\"", "--mount"});
  RecordingOptions options;
  options.T_base_camera = Pose::Identity();
  options.T_base_camera->translation().z() = 0.7;
  const ReadResult result = Read(options);
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.frames[1].obs.T_world_camera.translation(), Vector3d(0.1, 0, 0.7));
  options.bag.pose_topic = "/other";
  ExpectError(Read(options), {"--pose-topic", "/other", "there are /odom"});
  options.bag = {};
  options.bag.world_frame = "map";
  ExpectError(Read(options), {"no transforms from the world frame \"map\" to \"odom\""});
  AddStatic("map", "odom", {5, 0, 0, 0, 0, 0, 1});
  EXPECT_EQ(Read(options).frames.at(0).obs.T_world_camera.translation(), Vector3d(5, 0, 0.7));
}

TEST_F(MadeBag, ListsTheAlternativesIfAmbiguous) {
  AddSimple();
  AddDepth("/rear/depth/image", "rear");
  ExpectError(Read(),
              {"several depth cameras", "--depth-topic", "/depth/image, /rear/depth/image"});
  RecordingOptions options;
  options.bag.depth_topic = "/depth/image";
  EXPECT_TRUE(Read(options).recording);
  AddOdometry("/visual_odom", "cam");
  ExpectError(Read(options), {"several sources of poses", "--pose-topic", "/odom, /visual_odom"});
  options.bag.pose_topic = "/visual_odom";
  EXPECT_TRUE(Read(options).recording);
}

TEST_F(MadeBag, AHeadThatTurnsIsNoSourceOfPoses) {
  AddDepth("/depth/image", "cam");
  AddInfo("/depth/camera_info", {"cam", "", 8, 6, 0, {}, 6.0});
  for (int i = 0; i < 3; ++i)
    bag_.Add("/tf", "tf2_msgs/msg/TFMessage", Time(i),
             testing::TransformMessage(Time(i), "base", "cam", {0, 0, 0.1 * i, 0, 0, 0, 1}));
  AddOdometry("/odom", "base");
  ReadResult result = Read();
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_TRUE(result.frames[2].obs.T_world_camera.translation().isApprox(Vector3d(0.2, 0, 0.2)));
  // Once transforms say where the robot is, they are believed.
  for (int i = 0; i < 3; ++i)
    bag_.Add("/tf", "tf2_msgs/msg/TFMessage", Time(i),
             testing::TransformMessage(Time(i), "map", "base", {7, 0, 0, 0, 0, 0, 1}));
  result = Read();
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_TRUE(result.frames[2].obs.T_world_camera.translation().isApprox(Vector3d(7, 0, 0.2)));
}

TEST_F(MadeBag, ExtrinsicsComeFromTransformsOrAreAskedFor) {
  AddSimple();
  AddColour("/color/image", "color_optical");
  AddColour("/labels", "color_optical", "8SC3");
  AddInfo("/color/camera_info", {"color_optical", "", 8, 6, 0, {}, 6.0});
  ExpectError(Read(), {"no transform between the cameras", "color_optical", "--extrinsics"});
  AddStatic("cam", "color_optical", {0, 0, 0.5, 0, 0, 0, 1});
  const ReadResult result = Read();
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_FLOAT_EQ(result.frames[0].obs.depth_m.At(4, 3), 1.5F);
  EXPECT_EQ(result.frames[0].obs.T_world_camera.translation(), Vector3d(0, 0, 0.5));
}

TEST_F(MadeBag, UnsupportedLensesAndCamerasAreNamed) {
  AddDepth("/depth/image", "cam");
  AddOdometry("/odom", "cam");
  AddInfo("/depth/camera_info", {"cam", "equidistant", 8, 6, 0, {0.1, 0, 0, 0}, 6.0});
  ExpectError(Read(), {"equidistant", "/depth/image"});
  RecordingOptions options;
  options.colour = Pinhole{6, 6, 3.5, 2.5};
  EXPECT_TRUE(Read(options).recording) << "what is typed goes before it";
}

TEST_F(MadeBag, UncalibratedAndBinnedCamerasAreRefused) {
  AddDepth("/depth/image", "cam");
  AddDepth("/other_depth/image", "cam");
  AddOdometry("/odom", "cam");
  AddInfo("/depth/camera_info", {"cam", "", 8, 6, 0, {}, 0.0});
  AddInfo("/other_depth/camera_info", {"cam", "", 8, 6, 2, {}, 6.0});
  RecordingOptions options;
  options.bag.depth_topic = "/depth/image";
  ExpectError(Read(options), {"not calibrated", "--intrinsics"});
  options.bag.depth_topic = "/other_depth/image";
  ExpectError(Read(options), {"binned", "--intrinsics"});
}

TEST_F(MadeBag, MessagesThatContradictTheirTypeAreNamed) {
  AddSimple();
  bag_.Add("/tf", "tf2_msgs/msg/TFMessage", 2 * kSecond_ns, std::string("\0\1\0\0\xff\0\0\0", 8));
  ExpectError(Read(), {"made.mcap, /tf at 2.000 s", "no tf2_msgs/msg/TFMessage"});
}

TEST_F(MadeBag, ABrokenImageIsAnErrorOrLeftOut) {
  AddSimple();
  bag_.Add("/depth/image", "sensor_msgs/msg/Image", Time(2) + 1,
           testing::ImageMessage({Time(2), "cam", "32FC1", 8, 6, 32, "short", false}));
  ExpectError(Read(), {"/depth/image at 1.200 s", "fewer bytes"});
  RecordingOptions options;
  options.skip_damaged = true;
  const ReadResult result = Read(options);
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.recording->counts.damaged, 1);
  EXPECT_EQ(result.recording->counts.frames, 3);
}

TEST_F(MadeBag, OfAnotherSerialisationHoldsNoImages) {
  AddSimple();
  ExpectError(Read({}, "ros1"), {"no depth images (ROS 2, CDR)"});
}

}  // namespace
}  // namespace crossnav::recordings
