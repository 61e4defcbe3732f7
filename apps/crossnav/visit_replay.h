// SPDX-License-Identifier: MIT
// `suite run crossnav-lifelong-1 --keep-replays failures`: every visit is recorded while it is
// played, and the replays of visits with a goal that was not found are kept.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "replay_log.h"

namespace crossnav::app {

class VisitReplay {
 public:
  /// Records to `<folder>/<house>-day<day>.mcap`; nothing, where `folder` is empty.
  static Result<VisitReplay> Open(const std::filesystem::path& folder,
                                  const evaluation::SceneContext& context,
                                  const evaluation::HouseVisit& visit,
                                  const evaluation::RunConfig& config,
                                  const evaluation::VisitRun& run);

  evaluation::RunObserver* observer() const { return log_.get(); }  ///< null where none is kept

  /// After the visit: keeps or removes the replay. Error: a full disk.
  Result<void> Finish(const evaluation::VisitRecord& record);

 private:
  std::filesystem::path path_;
  std::unique_ptr<ReplayLog> log_;
};

}  // namespace crossnav::app
