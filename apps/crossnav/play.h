// SPDX-License-Identifier: MIT
// Plays one episode with all user-visible output: progress, replay and page, pictures, step trace
// and result record. Shared by `run` and `demo`.
#pragma once

#include <filesystem>
#include <string>

#include "perception_source.h"
#include "session.h"

namespace crossnav::watch {
class Watch;
}

namespace crossnav::app {

struct PlayFiles {
  std::filesystem::path folder;   ///< results.jsonl, trace.jsonl, floor_<id>.png
  std::filesystem::path replay;   ///< .mcap; empty = none
  std::filesystem::path page;     ///< .html; empty = none
  std::filesystem::path map;      ///< memory to save; empty = none
  std::filesystem::path memory;   ///< saved memory to start from; empty = none
  watch::Watch* watch = nullptr;  ///< shows the episode; null = nobody asked
  bool is_pose_known = true;      ///< false: the robot has to find itself in that memory
};

/// Fails unless all files can be written. Needs no scene, so that the message comes at once.
Result<void> CheckOutputs(const PlayFiles& files);

/// Runs the episode, writes the files, prints the summary and the paths.
Result<evaluation::EpisodeRecord> PlayEpisode(const evaluation::SceneContext& context,
                                              const evaluation::Episode& episode,
                                              const evaluation::RunConfig& config,
                                              const evaluation::RunHeader& header,
                                              const PlayFiles& files,
                                              const PerceptionSource& perception, Console& console);

}  // namespace crossnav::app
