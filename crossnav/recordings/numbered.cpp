// SPDX-License-Identifier: MIT
#include "crossnav/core/read_file.h"
#include "crossnav/recordings/folder.h"
#include "crossnav/recordings/text_rows.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

fs::path DepthFile(const fs::path& folder, const std::string& number) {
  std::error_code error;
  const fs::path pgm = folder / (number + ".pgm");
  return fs::exists(pgm, error) ? pgm : folder / (number + ".png");
}

}  // namespace

Result<Folder> OpenNumbered(const fs::path& path, const RecordingOptions& options) {
  const fs::path poses = path / "pose.txt";
  const auto text = ReadFile(poses);
  if (!text) return tl::unexpected(text.error());
  Folder folder;
  folder.format = "numbered frames";
  folder.path = path;
  folder.limits = options.poses;
  folder.limits.gap_ns = 0;
  folder.up = "-y";
  for (const TextRow& row : RowsOf(*text)) {
    const auto n = NumbersOf(row, 0, 7);
    if (!n) {
      return Fail(ErrorCode::kMalformed, "must hold x y z qx qy qz qw",
                  poses.string() + ", line " + std::to_string(row.line));
    }
    const auto& x = *n;
    const std::string number = std::to_string(folder.frames.size() + 1);
    const std::int64_t time_ns = static_cast<std::int64_t>(folder.frames.size()) * kUntimedFrame_ns;
    folder.poses.Add(time_ns, {x[0], x[1], x[2]}, Eigen::Quaterniond(x[6], x[3], x[4], x[5]));
    folder.frames.push_back(
        {time_ns, path / "color" / (number + ".png"), DepthFile(path / "depth", number)});
  }
  folder.poses.Sort();
  return folder;
}

}  // namespace crossnav::recordings
