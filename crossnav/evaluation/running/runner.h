// SPDX-License-Identifier: MIT
// Plays and judges an episode: simulator, perception and agent, stage by stage (benchmark.md,
// "Running"). The agent receives observations and the current goal's name only.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/core/observation.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::evaluation {

/// A step for observers, before its action is executed.
struct StepView {
  const Observation& observation;
  const trace::StepTrace& trace;
  const std::vector<trace::StageTime>& timing;
  const AgentPose& agent;  ///< true pose
  const agent::Agent& state;
  const perception::Percept& percept;
};

/// Cost of a step with the simulator, without observers [ms].
struct StepCost {
  double wall_ms = 0, cpu_ms = 0;
  double observe_wall_ms = 0, observe_cpu_ms = 0;  ///< rendering and moving
};

/// Observer of an episode: progress line, replay, pictures. Must not influence it, except that
/// OnStart may give the agent a saved memory.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Whether the observer reads colours; colours are rendered only if needed.
  virtual bool NeedsColour() const { return false; }
  virtual Result<void> OnStart(agent::Agent& /*state*/) { return {}; }
  virtual Result<void> OnStep(const StepView& /*step*/) { return {}; }
  virtual void OnStepCost(const StepCost& /*cost*/) {}
  virtual Result<void> OnStageEnd(const StageRecord& /*stage*/) { return {}; }
  virtual Result<void> OnEpisodeEnd(const agent::Agent& /*state*/,
                                    const EpisodeRecord& /*record*/) {
    return {};
  }
};

/// Creates the agent's perception for one episode; networks do not use the simulator.
using MakePerception = std::function<Result<perception::PerceptionSuite>(const sim::Simulator&)>;

/// `make_perception` serves `eval.perception = networks`; without it, perception is ground truth.
/// Errors: an episode that does not fit the scene (CheckPlayable), a malformed observation, a
/// failing observer. A goal that is not found is a record, not an error.
Result<EpisodeRecord> RunEpisode(const SceneContext& context, const Episode& episode,
                                 const RunConfig& config,
                                 std::span<RunObserver* const> observers = {},
                                 const MakePerception& make_perception = {});

}  // namespace crossnav::evaluation
