// SPDX-License-Identifier: MIT
// Trials of stairs and of false entrances: the agent starts with the entrance in view; the goal is
// on the other floor, or absent (trial_worlds.h). Judges only; perception is ground truth. The same
// seed gives the same attempt.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/evaluation/trials/trial_worlds.h"

namespace crossnav::evaluation {

/// A stair world with its navmesh, for attempts in both directions.
struct StairSite {
  StairWorld world;
  std::unique_ptr<SceneContext> context;
};
Result<StairSite> BuildStairSite(StairWorld world, const RunConfig& config);
inline Result<StairSite> BuildStairSite(world::StairKind kind, std::uint64_t seed,
                                        const RunConfig& config) {
  return BuildStairSite(MakeStairWorld(kind, seed), config);
}

struct StairAttempt {
  Episode episode;       ///< start and goal, to be played again
  EpisodeRecord record;  ///< of its one stage
  bool reached = false;  ///< the agent reached the other floor
  const StageRecord& stage() const { return record.stages.front(); }
  bool found() const { return stage().success; }
};

/// Budget: `config.eval.action_budget`. Error kNotFound: no start sees the entrance.
Result<StairAttempt> TryStair(const StairSite& site, bool goes_up, std::uint64_t seed,
                              const RunConfig& config);

/// Place where an agent started on a false stair.
struct FalseStart {
  int step = 0;
  Vector3d p_agent_world = Vector3d::Zero();
  Vector3d p_target_world = Vector3d::Zero();
  std::string target_kind;
};

struct FalseAttempt {
  int actions = 0;
  bool all_explored = false;
  std::optional<FalseStart> started;  ///< the first, if any
};

/// Searches for an absent goal until everything is explored or the budget is used up. A stair is
/// started by an activity `climb`, or under `policy.profile = paper` by a stair session. Error
/// kNotFound: no start sees it, or there is no walkable ground.
Result<FalseAttempt> TryFalseEntrance(FalseEntrance kind, std::uint64_t seed,
                                      const RunConfig& config);

}  // namespace crossnav::evaluation
