// SPDX-License-Identifier: MIT
// Plays and judges an episode: simulator, perception and agent, stage by stage (benchmark.md,
// "Running"). The agent receives observations and the current goal's name only.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/core/observation.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/localization/localizer.h"
#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/store/map_file.h"
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

/// How a robot that was lost came to know its pose, or did not.
struct Awoken {
  localization::LocalizeStep answer;
  int actions = 0;
  double off_m = 0, off_deg = 0;  ///< of a known pose from the true one
};

/// Observer of an episode: progress line, replay, pictures. Must not influence it, except that
/// OnStart may give the agent a saved memory, and LostIn one in which it has to find itself.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Whether the observer reads colours; colours are rendered only if needed.
  virtual bool NeedsColour() const { return false; }
  virtual Result<void> OnStart(agent::Agent& /*state*/) { return {}; }
  /// A saved memory in which the robot wakes up without its pose: it is localised before the first
  /// goal, and starts from the memory where that succeeds. Its actions count in the episode's.
  virtual Result<std::optional<store::LoadedMemory>> LostIn() { return std::nullopt; }
  virtual void OnAwoken(const Awoken& /*awoken*/) {}
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
