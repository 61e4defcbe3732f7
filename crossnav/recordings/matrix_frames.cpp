// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crossnav/core/read_file.h"
#include "crossnav/recordings/folder.h"
#include "crossnav/recordings/text_rows.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

/// Depth images, sorted by name.
Result<std::vector<fs::path>> DepthFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".png") files.push_back(at->path());
  if (error) return Fail(ErrorCode::kIo, "cannot be listed: " + error.message(), folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

/// K.txt: a 3 x 3 matrix in three rows.
Result<Pinhole> PinholeIn(const fs::path& file) {
  const auto text = ReadFile(file, 1 << 16);
  if (!text) return tl::unexpected(text.error());
  const std::vector<TextRow> rows = RowsOf(*text);
  const auto x = rows.size() == 3 ? NumbersOf(rows[0], 0, 3) : std::nullopt;
  const auto y = rows.size() == 3 ? NumbersOf(rows[1], 0, 3) : std::nullopt;
  if (!x || !y || !((*x)[0] > 0) || !((*y)[1] > 0))
    return Fail(ErrorCode::kMalformed, "must hold 3 rows of 3 numbers, the camera matrix",
                file.string());
  return Pinhole{(*x)[0], (*y)[1], (*x)[2], (*y)[2]};
}

/// A row of 16 numbers, a row-major matrix; false if its rotation is invalid.
bool AddPose(const std::vector<double>& n, std::int64_t time_ns, PoseTrack& poses) {
  Eigen::Matrix3d R;
  R << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const bool is_rotation = R.allFinite() &&
                           (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 0.01 &&
                           R.determinant() > 0;
  return is_rotation && poses.Add(time_ns, {n[3], n[7], n[11]}, Eigen::Quaterniond(R).normalized());
}

}  // namespace

Result<Folder> OpenMatrixFrames(const fs::path& path, const RecordingOptions& options) {
  const auto pinhole = PinholeIn(path / "K.txt");
  if (!pinhole) return tl::unexpected(pinhole.error());
  const auto depth = DepthFilesIn(path / "depth");
  if (!depth) return tl::unexpected(depth.error());
  const fs::path file = path / "poses.txt";
  const auto text = ReadFile(file);
  if (!text) return tl::unexpected(text.error());
  const std::vector<TextRow> rows = RowsOf(*text);
  if (rows.size() != depth->size())
    return Fail(ErrorCode::kMismatch,
                "has " + std::to_string(rows.size()) + " poses for " +
                    std::to_string(depth->size()) + " depth images",
                file.string());
  Folder folder;
  folder.format = "frames with a matrix each";
  folder.path = path;
  folder.limits = options.poses;
  folder.limits.gap_ns = 0;
  folder.up = "y";
  folder.colour = *pinhole;
  folder.are_intrinsics_of_images = true;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto n = NumbersOf(rows[i], 0, 16);
    if (!n)
      return Fail(ErrorCode::kMalformed, "must hold the 16 numbers of a 4 x 4 matrix",
                  file.string() + ", line " + std::to_string(rows[i].line));
    const std::int64_t time_ns = static_cast<std::int64_t>(i) * kUntimedFrame_ns;
    AddPose(*n, time_ns, folder.poses);  // lost poses are counted when used
    folder.frames.push_back({time_ns, path / "images" / (*depth)[i].filename(), (*depth)[i]});
  }
  folder.depth = folder.colour;
  folder.poses.Sort();
  return folder;
}

}  // namespace crossnav::recordings
