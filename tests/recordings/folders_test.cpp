// SPDX-License-Identifier: MIT
// Folders of images: TUM RGB-D, 7-Scenes, numbered frames; and five frames of a real sensor.
#include <gtest/gtest.h>

#include "recordings/wall_drive.h"
#include "support/places.h"
#include "support/temp_folder.h"

namespace crossnav::recordings {
namespace {

using testing::ExpectError;
using testing::ExpectFlat;
using testing::ReadAll;
using testing::ReadResult;

/// Intrinsics for images of 24 x 18 px.
RecordingOptions Small() {
  RecordingOptions options;
  options.colour = Pinhole{16, 16, 11.5, 8.5};
  return options;
}

class Folders : public ::testing::Test {
 protected:
  std::filesystem::path At(const std::string& name) const { return folder_.path() / name; }
  void Write(const std::string& name, const std::string& text) { test::WriteText(At(name), text); }

  /// Six depth images 0.1 s apart; poses every 0.05 s along +x that begin with the second image and
  /// leap before the last; no colour near the fourth.
  void WriteTum() {
    std::string rgb = "# color images\n", depth = "# depth maps\n", poses = "# ground truth\n";
    for (int i = 0; i < 6; ++i) {
      const std::string name = std::to_string(i) + ".png";
      testing::WriteDepth(At("depth/" + name), 3.0 - 0.1 * i, 1.0 / 5000);
      depth += "10." + std::to_string(i) + " depth/" + name + "\n";
      if (i == 3) continue;
      testing::WriteColour(At("rgb/" + name));
      rgb += "10." + std::to_string(i) + "0312 rgb/" + name + "\n";
    }
    for (int k = 1; k < 11; ++k) {
      const double x = k > 9 ? 9.0 : 0.05 * k + 0.025;
      poses += "10." + std::to_string(50 * k + 25 + 1000).substr(1) + " " + std::to_string(x) +
               " 0 1 -0.5 0.5 -0.5 0.5\n";
    }
    Write("rgb.txt", rgb);
    Write("depth.txt", depth);
    Write("groundtruth.txt", poses);
  }

  void WriteSevenScenes(const std::string& lost_row = "nan nan nan nan\n") {
    for (int i = 0; i < 4; ++i) {
      const std::string name = "frame-00000" + std::to_string(i);
      testing::WriteColour(At(name + ".color.png"));
      testing::WriteDepth(At(name + ".depth.png"), 2.0 - 0.05 * i, 0.001);
      const std::string z = std::to_string(0.05 * i);
      const std::string row = i == 2 ? lost_row : "1 0 0 0.5\n";
      Write(name + ".pose.txt", row + "0 1 0 0\n0 0 1 " + z + "\n0 0 0 1\n");
    }
  }

  test::TempFolder folder_;
};

TEST_F(Folders, TumIsMatchedInterpolatedAndCounted) {
  WriteTum();
  const ReadResult result = ReadAll(folder_.path(), Small());
  ASSERT_TRUE(result.recording) << result.error();
  const RecordingCounts& counts = result.recording->counts;
  EXPECT_EQ(result.recording->format, "TUM RGB-D folder");
  EXPECT_EQ(counts.depth_images, 6);
  EXPECT_EQ(counts.without_pose, 1);
  EXPECT_EQ(counts.without_colour, 1);
  EXPECT_EQ(counts.jumps, 1);
  EXPECT_EQ(counts.frames, 3);
  ASSERT_EQ(result.frames.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = std::array{1, 2, 4}[k];
    const Observation& obs = result.frames[k].obs;
    EXPECT_EQ(obs.time_ns, 10'000'000'000 + i * 100'000'000);
    EXPECT_TRUE(obs.T_world_camera.translation().isApprox(Vector3d(0.1 * i, 0, 1), 1e-6));
    ExpectFlat(obs.depth_m, 3.0 - 0.1 * i);
    EXPECT_EQ(obs.rgb.data, testing::Gradient(24, 18).data);
    EXPECT_EQ(obs.camera.fx, 16);
  }
  EXPECT_EQ(result.frames.back().share_done, 5.0 / 6);
}

TEST_F(Folders, SevenScenesHasOnePoseAFrameAndSkipsLostPoses) {
  for (const char* lost :
       {"nan nan nan nan\n", "-1.#IND -1.#IND -1.#IND -1.#IND\n", "inf 0 0 0\n"}) {
    WriteSevenScenes(lost);
    const ReadResult result = ReadAll(folder_.path(), Small());
    ASSERT_TRUE(result.recording) << result.error();
    EXPECT_EQ(result.recording->counts.frames, 3);
    EXPECT_EQ(result.recording->counts.without_pose, 1);
    // The camera's own axes: z forward is our x, x right is our -y.
    const Observation& last = result.frames.back().obs;
    EXPECT_TRUE(last.T_world_camera.translation().isApprox(Vector3d(0.15, -0.5, 0), 1e-9));
    EXPECT_TRUE(last.T_world_camera.linear().col(2).isApprox(Vector3d::UnitX()));
    ExpectFlat(last.depth_m, 1.85);
  }
}

TEST_F(Folders, SevenScenesRegistersItsDepthByTheGivenIntrinsics) {
  WriteSevenScenes();
  RecordingOptions options = Small();
  options.depth = Pinhole{12, 12, 11.5, 8.5};  // sees more than the colour camera
  options.T_colour_depth = Pose::Identity();
  options.T_colour_depth->translation().x() = -0.025;
  const ReadResult result = ReadAll(folder_.path(), options);
  ASSERT_TRUE(result.recording) << result.error();
  ExpectFlat(result.frames[0].obs.depth_m, 2.0);
  EXPECT_NEAR(result.frames[0].obs.T_world_camera.translation().y(), -0.525, 1e-9)
      << "the poses are those of the depth camera";
}

TEST_F(Folders, ErrorsNameTheFileAndItsExpectedContent) {
  WriteTum();
  ExpectError(ReadAll(folder_.path()), {folder_.path().string(), "24 x 18", "--intrinsics"});
  const std::string depth = test::ReadText(At("depth.txt"));
  Write("depth.txt", depth + "10.9 depth/0.png more\n");
  ExpectError(ReadAll(folder_.path(), Small()), {"depth.txt, line 8", "a time in seconds"});
  Write("depth.txt", depth);
  const std::string poses = test::ReadText(At("groundtruth.txt"));
  Write("groundtruth.txt", poses + "10.9 1 2 3\n");
  ExpectError(ReadAll(folder_.path(), Small()), {"groundtruth.txt, line 12", "tx ty tz"});
  Write("groundtruth.txt", "# nothing\n");
  ExpectError(ReadAll(folder_.path(), Small()), {"groundtruth.txt", "no pose"});
  std::filesystem::remove(At("groundtruth.txt"));
  ExpectError(ReadAll(folder_.path(), Small()), {"groundtruth.txt", "cannot be opened"});
  ExpectError(ReadAll(At("nowhere")), {"nowhere", "no such file"});
  ExpectError(ReadAll(At("rgb")), {"no recording that is known", "TUM RGB-D", "7-Scenes", "ROS 2"});
}

TEST_F(Folders, ABrokenImageIsAnErrorOrLeftOut) {
  WriteTum();
  std::filesystem::resize_file(At("depth/2.png"), 60);
  ExpectError(ReadAll(folder_.path(), Small()), {"depth/2.png", "broken PNG"});
  std::filesystem::remove(At("rgb/4.png"));
  RecordingOptions options = Small();
  options.skip_damaged = true;
  const ReadResult result = ReadAll(folder_.path(), options);
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.recording->counts.damaged, 2);
  EXPECT_EQ(result.recording->counts.frames, 1);
}

TEST_F(Folders, ARecordingWithoutAUsableFrameSaysWhereTheyWent) {
  WriteTum();
  Write("groundtruth.txt", "99.0 0 0 0 0 0 0 1\n");
  ExpectError(ReadAll(folder_.path(), Small()), {"none of 6 depth images", "5 no pose"});
}

TEST_F(Folders, ImagesOfAnotherSizeThanTheFirstAreAnError) {
  WriteSevenScenes();
  testing::WriteColour(At("frame-000001.color.png"), 30, 20);
  ExpectError(ReadAll(folder_.path(), Small()), {"30 x 20", "24 x 18"});
}

TEST_F(Folders, IntrinsicsAndPosesThatAreNoNumbersAreErrors) {
  WriteTum();
  RecordingOptions options = Small();
  options.colour->cx = std::numeric_limits<double>::quiet_NaN();
  ExpectError(ReadAll(folder_.path(), options), {"depth/1.png", "intrinsics"});
  options = Small();
  options.T_base_camera = Pose::Identity();
  options.T_base_camera->translation().x() = 1e300;
  ExpectError(ReadAll(folder_.path(), options), {"depth/1.png", "not finite"});
}

TEST_F(Folders, TheAxisThatPointsUpAndTheMountingAreApplied) {
  WriteTum();
  RecordingOptions options = Small();
  options.up = "y";
  options.T_base_camera = Pose::Identity();
  options.T_base_camera->translation().z() = 0.3;
  const ReadResult result = ReadAll(folder_.path(), options);
  ASSERT_TRUE(result.recording) << result.error();
  // In the recording's world (0.1, 0, 1), and 0.3 m further along the optical axis, which is +x.
  EXPECT_TRUE(
      result.frames[0].obs.T_world_camera.translation().isApprox(Vector3d(-1, -0.4, 0), 1e-6));
  options.up = "x";
  ExpectError(ReadAll(folder_.path(), options), {"z, y or -y"});
}

TEST(RealFrames, FiveOfADepthCameraAreRead) {
  const std::string path = test::SharedPath("data/rgbd");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real frames beside the project";
  RecordingOptions options;
  ExpectError(ReadAll(path, options), {"640 x 480", "--intrinsics"});
  options.colour = Pinhole{518, 519, 325.5, 253.5};
  const ReadResult result = ReadAll(path, options);
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.recording->counts.frames, 5);
  EXPECT_EQ(result.recording->format, "numbered frames");
  for (const RecordedFrame& frame : result.frames) {
    const auto& data = frame.obs.depth_m.data;
    const auto valid = std::count_if(data.begin(), data.end(), [](float d) { return d > 0.1F; });
    EXPECT_GT(valid, static_cast<long>(data.size()) / 2);
    EXPECT_TRUE(IsValidPose(frame.obs.T_world_camera));
  }
}

}  // namespace
}  // namespace crossnav::recordings
