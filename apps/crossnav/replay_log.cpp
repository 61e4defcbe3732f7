// SPDX-License-Identifier: MIT
#include "replay_log.h"

#include <algorithm>

#include "crossnav/agent/sight.h"

namespace crossnav::app {

trace::ReplayInfo ReplayInfoOf(const evaluation::SceneContext& context,
                               const evaluation::Episode& episode,
                               const evaluation::RunConfig& config,
                               const evaluation::RunHeader& header) {
  trace::ReplayInfo info;
  info.scene_id = context.scene().id;
  info.episode_id = episode.episode_id;
  info.goals = episode.goals;
  info.variant = header.variant;
  info.perception = header.perception;
  info.version = header.version;
  info.config_hash = header.config_hash;
  info.seed = header.seed;
  info.voxel_m = config.agent.map.voxel_m;
  for (const std::string& goal : episode.goals) {
    for (const evaluation::Target& target : context.TargetsOf(goal)) {
      info.goal_instances.push_back({goal, target.box});
    }
  }
  return info;
}

trace::StageResult StageResultOf(const evaluation::StageRecord& stage, int goal_index,
                                 int last_step) {
  return {goal_index,      stage.goal, std::string(evaluation::NameOf(stage.outcome)),
          stage.success,   last_step,  stage.length_m,
          stage.shortest_m};
}

Result<std::unique_ptr<ReplayLog>> ReplayLog::Open(const evaluation::SceneContext& context,
                                                   const evaluation::Episode& episode,
                                                   const evaluation::RunConfig& config,
                                                   const evaluation::RunHeader& header,
                                                   const std::filesystem::path& path) {
  std::error_code ignored;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  auto writer = trace::ReplayWriter::Open(path, ReplayInfoOf(context, episode, config, header));
  if (!writer) return tl::unexpected(writer.error());
  return std::unique_ptr<ReplayLog>(new ReplayLog(std::move(*writer)));
}

namespace {

/// The step with the whole map as its changes: of a saved memory, a replay would show nothing else.
trace::StepTrace WithWholeMap(const evaluation::StepView& step) {
  trace::StepTrace whole = step.trace;
  whole.voxel_changes.clear();
  step.state.map().ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    whole.voxel_changes.push_back({key, voxel});
  });
  std::sort(whole.voxel_changes.begin(), whole.voxel_changes.end(),
            [](const auto& a, const auto& b) { return a.key < b.key; });
  return whole;
}

}  // namespace

Result<void> ReplayLog::OnStep(const evaluation::StepView& step) {
  last_step_ = step.trace.step;
  goal_index_ = step.trace.goal_index;
  const trace::Sight sight = agent::SightOf(step.percept, step.state.goal_text());
  const auto changes = static_cast<std::int64_t>(step.trace.voxel_changes.size());
  const bool is_remembered = is_first_ && step.state.map().Stats().known > changes;
  is_first_ = false;
  const auto graph = graph_.Update(step.state, step.trace);
  const trace::GraphNote* note = graph ? &*graph : nullptr;
  if (is_remembered) return writer_.Write({WithWholeMap(step), &step.observation, &sight, note});
  return writer_.Write({step.trace, &step.observation, &sight, note});
}

Result<void> ReplayLog::OnStageEnd(const evaluation::StageRecord& stage) {
  return writer_.WriteStage(StageResultOf(stage, goal_index_, last_step_));
}

}  // namespace crossnav::app
