// SPDX-License-Identifier: MIT
// Writes a replay while an episode runs: MCAP with Foxglove's messages and our own step records
// (docs/formats/replay.md). A step costs a few milliseconds. Times are step x 0.1 s from 0, so the
// same episode gives the same bytes. Not thread-safe.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/core/result.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

struct ReplayOptions {
  int image_px = 320;          // chosen: legible in the page, about 12 kB a step
  int jpeg_quality = 80;       // chosen: no visible blocks at that size
  int depth_px = 160;          // chosen: a preview, not data to map from
  int maps_px = 96;            // chosen: of masks, stairs and similarity, under 2 kB a step
  int cloud_every_steps = 20;  // chosen: whole maps for other viewers are large; 0 = never
};

class ReplayWriter {
 private:
  struct Impl;

 public:
  /// Creates `<path>.part`; Close() renames it.
  static Result<ReplayWriter> Open(const std::filesystem::path& path, const ReplayInfo& info,
                                   const ReplayOptions& options = {});
  ~ReplayWriter();
  ReplayWriter(ReplayWriter&&) noexcept;
  ReplayWriter& operator=(ReplayWriter&&) noexcept;

  /// Steps in increasing order. Errors: a full disk, a step number that does not increase.
  Result<void> Write(const ReplayFrame& frame);

  /// After the goal's last step.
  Result<void> WriteStage(const StageResult& stage);

  Result<void> Close();

 private:
  explicit ReplayWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::trace
