// SPDX-License-Identifier: MIT
#include "crossnav/recordings/recording.h"

#include <algorithm>
#include <vector>

#include "crossnav/recordings/folder.h"
#include "crossnav/recordings/ros_bag.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnown =
    "; it must be a TUM RGB-D folder (rgb.txt, depth.txt, groundtruth.txt), a sequence of 7-Scenes "
    "(frame-000000.color.png, .depth.png, .pose.txt), a folder of numbered frames (color, depth, "
    "pose.txt), one of frames with a matrix each (images, depth, K.txt, poses.txt), or a ROS 2 bag "
    "(.mcap, or the folder with its metadata.yaml)";

bool Holds(const fs::path& folder, const std::vector<const char*>& names) {
  std::error_code error;
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return fs::exists(folder / name, error); });
}

/// Whether a file in the folder has this ending.
bool HoldsFile(const fs::path& folder, std::string_view end) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error), last; !error && at != last; at.increment(error))
    if (at->path().filename().string().ends_with(end)) return true;
  return false;
}

using OpenFolder = Result<Folder> (*)(const fs::path&, const RecordingOptions&);

/// Reader of a folder of images; null for other folders.
OpenFolder ReaderOf(const fs::path& path) {
  if (Holds(path, {"groundtruth.txt", "rgb.txt", "depth.txt"})) return OpenTum;
  if (HoldsFile(path, ".pose.txt")) return OpenSevenScenes;
  if (Holds(path, {"pose.txt"})) return OpenNumbered;
  if (Holds(path, {"poses.txt"}) && Holds(path, {"K.txt"})) return OpenMatrixFrames;
  return nullptr;
}

}  // namespace

Result<Recording> ReadRecording(const fs::path& path, const RecordingOptions& options,
                                const FrameVisitor& visit) {
  std::error_code error;
  if (!fs::exists(path, error))
    return Fail(ErrorCode::kNotFound, "there is no such file or folder", path.string());
  const bool is_folder = fs::is_directory(path, error);
  if (!is_folder && path.extension() == ".mcap") return ReadRosBag({path}, options, visit);
  if (is_folder && (Holds(path, {"metadata.yaml"}) || HoldsFile(path, ".mcap"))) {
    const auto files = BagFilesOf(path);
    if (!files) return tl::unexpected(files.error());
    return ReadRosBag(*files, options, visit);
  }
  const OpenFolder open = is_folder ? ReaderOf(path) : nullptr;
  if (open == nullptr)
    return Fail(ErrorCode::kUnsupported, std::string("is no recording that is known") + kKnown,
                path.string());
  const auto folder = open(path, options);
  if (!folder) return tl::unexpected(folder.error());
  return ReadFolder(*folder, options, visit);
}

}  // namespace crossnav::recordings
