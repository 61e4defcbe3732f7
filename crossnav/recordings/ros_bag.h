// SPDX-License-Identifier: MIT
// ROS 2 bags in MCAP files with CDR messages. Two passes: first the small messages (transforms,
// odometry, camera parameters), then the images, of which a few at a time are held.
#pragma once

#include <filesystem>
#include <vector>

#include "crossnav/recordings/recording.h"

namespace crossnav::recordings {

/// The .mcap files of a bag folder in the order of its metadata.yaml, or sorted by name without it.
/// Errors: another storage, compressed files, no files.
Result<std::vector<std::filesystem::path>> BagFilesOf(const std::filesystem::path& folder);

Result<Recording> ReadRosBag(const std::vector<std::filesystem::path>& files,
                             const RecordingOptions& options, const FrameVisitor& visit);

}  // namespace crossnav::recordings
