// SPDX-License-Identifier: MIT
// Plays one episode: simulator, perception and agent, stage by stage, and judges it (benchmark.md,
// "Running"). The agent sees observations and the current goal's name only.
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

/// One step as an observer sees it, before its action is executed.
struct StepView {
  const Observation& observation;
  const trace::StepTrace& trace;
  const std::vector<trace::StageTime>& timing;
  const AgentPose& agent;  ///< true pose
  const agent::Agent& state;
  const perception::Percept& percept;
};

/// What one step took, simulator included, observers not [ms].
struct StepCost {
  double wall_ms = 0, cpu_ms = 0;
  double observe_wall_ms = 0, observe_cpu_ms = 0;  ///< rendering and moving
};

/// Watches an episode: progress line, replay, pictures. Must not influence it, except that OnStart
/// may give the agent a saved memory.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Whether it looks at the colours of observations; where nobody does they are not rendered.
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

/// Makes the agent's perception for one episode; networks need nothing of the simulator.
using MakePerception = std::function<Result<perception::PerceptionSuite>(const sim::Simulator&)>;

/// `make_perception` answers `eval.perception = networks`; left out, perception is ground truth.
/// Errors: an episode that does not fit the scene (CheckPlayable), a malformed observation, a
/// failing observer. A goal that is not found is a record, not an error.
Result<EpisodeRecord> RunEpisode(const SceneContext& context, const Episode& episode,
                                 const RunConfig& config,
                                 std::span<RunObserver* const> observers = {},
                                 const MakePerception& make_perception = {});

}  // namespace crossnav::evaluation
