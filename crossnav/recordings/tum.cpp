// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/core/read_file.h"
#include "crossnav/recordings/folder.h"
#include "crossnav/recordings/text_rows.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

struct TimedFile {
  std::int64_t time_ns;
  fs::path file;
};

tl::unexpected<Error> BadRow(const fs::path& file, const TextRow& row, const char* form) {
  return Fail(ErrorCode::kMalformed, std::string("must hold ") + form,
              file.string() + ", line " + std::to_string(row.line));
}

/// Rows of time and file name, sorted by time.
Result<std::vector<TimedFile>> ReadList(const fs::path& list) {
  const auto text = ReadFile(list);
  if (!text) return tl::unexpected(text.error());
  std::vector<TimedFile> files;
  for (const TextRow& row : RowsOf(*text)) {
    const auto time_ns = row.words.size() == 2 ? TimeOf(row.words[0]) : std::nullopt;
    if (!time_ns) return BadRow(list, row, "a time in seconds and a file's name");
    files.push_back({*time_ns, list.parent_path() / std::string(row.words[1])});
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const TimedFile& a, const TimedFile& b) { return a.time_ns < b.time_ns; });
  if (files.empty()) return Fail(ErrorCode::kMalformed, "names no images", list.string());
  return files;
}

Result<PoseTrack> ReadPoses(const fs::path& file) {
  const auto text = ReadFile(file);
  if (!text) return tl::unexpected(text.error());
  PoseTrack track;
  for (const TextRow& row : RowsOf(*text)) {
    const auto time_ns = TimeOf(row.words[0]);
    const auto n = NumbersOf(row, 1, 7);
    if (!time_ns || !n) return BadRow(file, row, "time tx ty tz qx qy qz qw");
    const auto& x = *n;
    track.Add(*time_ns, {x[0], x[1], x[2]}, Eigen::Quaterniond(x[6], x[3], x[4], x[5]));
  }
  track.Sort();
  if (track.empty()) return Fail(ErrorCode::kMalformed, "holds no pose", file.string());
  return track;
}

/// The file nearest in time, or empty if none is within `most_ns`.
fs::path Nearest(const std::vector<TimedFile>& files, std::int64_t time_ns, std::int64_t most_ns) {
  const auto after =
      std::lower_bound(files.begin(), files.end(), time_ns,
                       [](const TimedFile& file, std::int64_t t) { return file.time_ns < t; });
  const TimedFile* best = nullptr;
  std::int64_t best_ns = most_ns;
  for (auto at = after == files.begin() ? after : after - 1; at != files.end() && at <= after;
       ++at) {
    const std::int64_t away_ns = std::abs(at->time_ns - time_ns);
    if (away_ns > best_ns) continue;
    best = &*at;
    best_ns = away_ns;
  }
  return best != nullptr ? best->file : fs::path();
}

}  // namespace

Result<Folder> OpenTum(const fs::path& path, const RecordingOptions& options) {
  const auto colour = ReadList(path / "rgb.txt");
  if (!colour) return tl::unexpected(colour.error());
  const auto depth = ReadList(path / "depth.txt");
  if (!depth) return tl::unexpected(depth.error());
  auto poses = ReadPoses(path / "groundtruth.txt");
  if (!poses) return tl::unexpected(poses.error());
  Folder folder;
  folder.format = "TUM RGB-D folder";
  folder.path = path;
  folder.poses = std::move(*poses);
  folder.limits = options.poses;
  // The benchmark's recommendation for registered depth, as in its images.
  folder.colour = folder.depth = Pinhole{525.0, 525.0, 319.5, 239.5};
  folder.depth_unit_m = 1.0 / 5000;
  const auto most_ns = static_cast<std::int64_t>(std::llround(options.match_s * 1e9));
  for (const TimedFile& file : *depth)
    folder.frames.push_back({file.time_ns, Nearest(*colour, file.time_ns, most_ns), file.file});
  return folder;
}

}  // namespace crossnav::recordings
