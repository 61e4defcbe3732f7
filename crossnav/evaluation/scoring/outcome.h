// SPDX-License-Identifier: MIT
// Outcome of an executed stage (benchmark.md, "Running" and "Outcome of an executed stage"). Judges
// only: the agent cannot see it. World frame, metres.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::evaluation {

inline bool Holds(const std::vector<int>& floors, int floor) {
  return std::find(floors.begin(), floors.end(), floor) != floors.end();
}

/// True where a STOP at `p_world` on `floor` reaches the target under `eval.success = box`:
/// horizontally within the radius of its box AND on the floor of one of its viewpoints.
bool IsWithinBoxRadius(const Target& target, const Vector3d& p_world, int floor,
                       const EvalConfig& eval);

/// True if a STOP at `p_world` is a success for one of `targets`.
bool IsGoalReached(const SceneContext& context, const std::vector<Target>& targets,
                   const Vector3d& p_world, const EvalConfig& eval);

/// Horizontally within the radius of a target, but on none of its floors.
bool IsOnWrongFloor(const std::vector<Target>& targets, const Vector3d& p_world, int floor,
                    const EvalConfig& eval);

/// Facts at the end of a stage.
struct StageEnd {
  bool stopped = false;        ///< the agent issued STOP
  bool is_reached = false;     ///< and the goal was within reach
  bool is_claim_near = false;  ///< the claimed point lies within the radius of a true instance
  bool all_explored = false;   ///< no candidate was left
  double recent_path_m = 0;    ///< distance moved in the last eval.stuck_steps steps
};
Outcome JudgeStage(const StageEnd& end, const EvalConfig& eval);

/// Follows the events of one stage at the stairs. never_found includes entrances that were seen and
/// never visited.
class StairWatch {
 public:
  void Add(const trace::StepTrace& step);
  /// never_found, entrance_rejected, lost_on_flight, landing_not_confirmed, or empty if the stairs
  /// were no problem. `transitions` are true arrivals on another floor.
  std::string Verdict(int transitions) const;

 private:
  bool has_session_ = false;
  bool has_rejection_ = false;
  bool has_landing_ = false;
};

}  // namespace crossnav::evaluation
