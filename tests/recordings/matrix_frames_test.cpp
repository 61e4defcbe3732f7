// SPDX-License-Identifier: MIT
// Frames with a 4 x 4 matrix each and one camera matrix, as HoloLens recordings are handed around.
#include <gtest/gtest.h>

#include "recordings/wall_drive.h"
#include "support/temp_folder.h"

namespace crossnav::recordings {
namespace {

using testing::ExpectError;
using testing::ReadAll;
using testing::ReadResult;

class MatrixFrames : public ::testing::Test {
 protected:
  std::filesystem::path At(const std::string& name) const { return folder_.path() / name; }
  void Write(const std::string& name, const std::string& text) { test::WriteText(At(name), text); }

  /// Three frames, the world's up is y, 0.1 m apart.
  void WriteFrames() {
    std::string poses;
    for (int i = 0; i < 3; ++i) {
      testing::WriteDepth(At("depth/" + std::to_string(i) + ".png"), 2.0, 0.001);
      testing::WriteColour(At("images/" + std::to_string(i) + ".png"));
      poses += "1 0 0 " + std::to_string(0.1 * i) + " 0 -1 0 1.5 0 0 -1 0 0 0 0 1\n";
    }
    Write("poses.txt", poses);
    Write("K.txt", "16 0 11.5\n0 16 8.5\n0 0 1\n");
  }

  test::TempFolder folder_;
};

TEST_F(MatrixFrames, AreReadWithTheirPoses) {
  WriteFrames();
  const ReadResult result = ReadAll(folder_.path());
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.recording->format, "frames with a matrix each");
  ASSERT_EQ(result.frames.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const Observation& obs = result.frames[i].obs;
    EXPECT_NEAR(obs.T_world_camera.translation().z(), 1.5, 1e-6);  // y of the file is up
    EXPECT_NEAR(obs.T_world_camera.translation().head<2>().norm(), 0.1 * i, 1e-6);
    EXPECT_NEAR(obs.camera.fx, 16, 1e-9);
    EXPECT_NEAR(obs.depth_m.At(5, 5), 2.0, 1e-3);
  }
}

TEST_F(MatrixFrames, FaultsNameTheFile) {
  WriteFrames();
  Write("K.txt", "16 0 11.5\n0 16\n");
  ExpectError(ReadAll(folder_.path()), {"K.txt", "3 rows of 3"});
  Write("K.txt", "16 0 11.5\n0 0 8.5\n0 0 1\n");
  ExpectError(ReadAll(folder_.path()), {"K.txt"});
  WriteFrames();
  Write("poses.txt", "1 0 0 0 0 -1 0 1.5 0 0 -1 0 0 0 0 1\n");
  ExpectError(ReadAll(folder_.path()), {"poses.txt", "1 poses for 3"});
  Write("poses.txt", "1 0 0\n1 0 0\n1 0 0\n");
  ExpectError(ReadAll(folder_.path()), {"poses.txt, line 1", "16 numbers"});
  WriteFrames();
  std::filesystem::remove_all(At("depth"));
  ExpectError(ReadAll(folder_.path()), {"depth"});
}

TEST_F(MatrixFrames, AMatrixThatIsNoRotationIsALostPose) {
  WriteFrames();
  const std::string good = "1 0 0 0 0 -1 0 1.5 0 0 -1 0 0 0 0 1\n";
  Write("poses.txt", good + "nan 0 0 0 0 -1 0 1.5 0 0 -1 0 0 0 0 1\n" + good);
  const ReadResult result = ReadAll(folder_.path());
  ASSERT_TRUE(result.recording) << result.error();
  EXPECT_EQ(result.recording->counts.without_pose, 1);
  EXPECT_EQ(result.recording->counts.frames, 2);
}

}  // namespace
}  // namespace crossnav::recordings
