// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crossnav/core/read_file.h"
#include "crossnav/recordings/folder.h"
#include "crossnav/recordings/text_rows.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kKinectFrame_ns = 33'333'333;  // the Kinect's 30 frames a second

/// Numbers of the frames with a pose, sorted.
Result<std::vector<int>> FramesIn(const fs::path& path) {
  std::vector<int> frames;
  std::error_code error;
  for (fs::directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with("frame-") || !name.ends_with(".pose.txt")) continue;
    const auto number = NumberOf(std::string_view(name).substr(6, name.size() - 15));
    if (name.size() != 21 || !number)
      return Fail(ErrorCode::kMalformed, "is not named frame-NNNNNN.pose.txt", at->path().string());
    frames.push_back(static_cast<int>(*number));
  }
  if (error) return Fail(ErrorCode::kIo, "cannot be listed: " + error.message(), path.string());
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::string NameOf(int frame, const char* suffix) {
  std::string digits = std::to_string(frame);
  digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
  return "frame-" + digits + suffix;
}

/// A matrix of 4 x 4 numbers, camera to world. Lost poses are skipped.
Result<void> AddPose(const fs::path& file, std::int64_t time_ns, PoseTrack& poses) {
  const auto text = ReadFile(file, 1 << 16);
  if (!text) return tl::unexpected(text.error());
  const std::vector<TextRow> rows = RowsOf(*text);
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  bool is_good = rows.size() == 4;
  for (std::size_t i = 0; is_good && i < 4; ++i) {
    const auto row = NumbersOf(rows[i], 0, 4);
    is_good = row.has_value();
    for (std::size_t k = 0; is_good && k < 4; ++k)
      M(static_cast<int>(i), static_cast<int>(k)) = (*row)[k];
  }
  if (!is_good) return Fail(ErrorCode::kMalformed, "must hold 4 rows of 4 numbers", file.string());
  const Eigen::Matrix3d R = M.topLeftCorner<3, 3>();
  const bool is_rotation = M.allFinite() &&
                           (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 0.01 &&
                           R.determinant() > 0;
  if (is_rotation) poses.Add(time_ns, M.topRightCorner<3, 1>(), Eigen::Quaterniond(R).normalized());
  return {};
}

}  // namespace

Result<Folder> OpenSevenScenes(const fs::path& path, const RecordingOptions& options) {
  const auto frames = FramesIn(path);
  if (!frames) return tl::unexpected(frames.error());
  Folder folder;
  folder.format = "7-Scenes folder";
  folder.path = path;
  folder.limits = options.poses;
  folder.limits.gap_ns = 0;  // one pose a frame: lost poses are not interpolated
  folder.are_poses_of_depth = true;
  // The Kinect's usual values; the data set has no calibration of its own.
  folder.colour = Pinhole{525.0, 525.0, 320.0, 240.0};
  folder.depth = Pinhole{585.0, 585.0, 320.0, 240.0};
  folder.up = "-y";
  for (const int frame : *frames) {
    const std::int64_t time_ns = frame * kKinectFrame_ns;
    auto ok = AddPose(path / NameOf(frame, ".pose.txt"), time_ns, folder.poses);
    if (!ok) return tl::unexpected(ok.error());
    folder.frames.push_back(
        {time_ns, path / NameOf(frame, ".color.png"), path / NameOf(frame, ".depth.png")});
  }
  folder.poses.Sort();
  return folder;
}

}  // namespace crossnav::recordings
