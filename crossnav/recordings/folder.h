// SPDX-License-Identifier: MIT
// Recordings as folders of image files: description of each format, and the common reader.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/recordings/recording.h"

namespace crossnav::recordings {

// chosen: frames without times lie far apart
inline constexpr std::int64_t kUntimedFrame_ns = 1'000'000'000;

struct FolderFrame {
  std::int64_t time_ns = 0;             ///< of the depth image
  std::filesystem::path colour, depth;  ///< colour empty: none near in time
};

struct Folder {
  std::string format;
  std::filesystem::path path;
  std::vector<FolderFrame> frames;  ///< in the order of time
  PoseTrack poses;                  ///< camera (or robot) to the folder's world
  PoseLimits limits;
  bool are_poses_of_depth = false;        ///< else of the colour camera
  std::optional<Pinhole> colour, depth;   ///< of 640 x 480 px; empty: the user must say
  bool are_intrinsics_of_images = false;  ///< of the images in their actual size
  double depth_unit_m = 0.001;
  std::string up = "z";
};

/// rgb.txt, depth.txt and groundtruth.txt: vision.in.tum.de/data/datasets/rgbd-dataset/file_formats
Result<Folder> OpenTum(const std::filesystem::path& path, const RecordingOptions& options);
/// frame-000000.color.png, .depth.png and .pose.txt: one pose a frame, 30 frames a second.
Result<Folder> OpenSevenScenes(const std::filesystem::path& path, const RecordingOptions& options);
/// color/N.png, depth/N.pgm (or .png), and a row of pose.txt for each N from 1: x y z qx qy qz qw.
/// One pose a frame, no times.
Result<Folder> OpenNumbered(const std::filesystem::path& path, const RecordingOptions& options);
/// K.txt, poses.txt (a 4 x 4 matrix a row, camera to world, y up), images/NAME.png, depth/NAME.png
/// in the order of their names. One pose a frame, no times.
Result<Folder> OpenMatrixFrames(const std::filesystem::path& path, const RecordingOptions& options);

Result<Recording> ReadFolder(const Folder& folder, const RecordingOptions& options,
                             const FrameVisitor& visit);

}  // namespace crossnav::recordings
