// SPDX-License-Identifier: MIT
#include "visit_replay.h"

#include <fmt/format.h>

#include <algorithm>

namespace crossnav::app {

namespace fs = std::filesystem;

Result<VisitReplay> VisitReplay::Open(const fs::path& folder,
                                      const evaluation::SceneContext& context,
                                      const evaluation::HouseVisit& visit,
                                      const evaluation::RunConfig& config,
                                      const evaluation::VisitRun& run) {
  VisitReplay replay;
  if (folder.empty()) return replay;
  evaluation::Episode episode;
  episode.episode_id = fmt::format("{}-day{}", visit.house, visit.day);
  episode.scene_id = visit.scene_id;
  episode.start = visit.start;
  for (const evaluation::VisitGoal& goal : visit.goals) episode.goals.push_back(goal.goal);
  evaluation::RunHeader header;
  header.variant = run.memory_mode;
  header.config_hash = run.config_hash;
  header.version = run.version;
  header.perception = run.perception;
  replay.path_ = folder / evaluation::ReplayName(episode.episode_id);
  auto log = ReplayLog::Open(context, episode, config, header, replay.path_);
  if (!log) return tl::unexpected(log.error());
  replay.log_ = std::move(*log);
  return replay;
}

Result<void> VisitReplay::Finish(const evaluation::VisitRecord& record) {
  if (!log_) return {};
  if (auto ok = log_->Close(); !ok) return ok;
  const bool is_found = std::all_of(record.goals.begin(), record.goals.end(),
                                    [](const auto& goal) { return goal.success; });
  std::error_code ignored;
  if (is_found) fs::remove(path_, ignored);
  return {};
}

}  // namespace crossnav::app
