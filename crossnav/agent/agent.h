// SPDX-License-Identifier: MIT
// The agent: one observation in, one action out (paper, fig:framework). Everything it knows comes
// from observations, the perception suite and the goal's name. Reset between episodes = a new
// Agent. World frame, metres. Not thread-safe.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/agent/config.h"
#include "crossnav/core/action.h"
#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/objects/object_record.h"
#include "crossnav/perception/perception.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::agent {

class Hooks;

struct StepResult {
  Action action = Action::kStop;
  trace::StepTrace trace;
  perception::Percept percept;              ///< result of perception for the frame
  std::vector<trace::StageTime> timing;     ///< CPU ms per stage, in order
  bool all_explored = false;                ///< no candidate is left; `action` is meaningless then
  std::optional<Vector3d> p_claimed_world;  ///< with kStop: where the agent believes the goal to be
};

class Agent {
 private:
  struct Impl;

 public:
  /// `hooks` replace decisions of the policy (agent/hooks.h, policy.profile = full); they must
  /// outlive the agent.
  Agent(const Config& config, perception::PerceptionSuite perception, Hooks* hooks = nullptr);
  ~Agent();
  Agent(Agent&&) noexcept;

  /// Activates a goal: the name of a category or an object, or a description of one ("the red chair
  /// upstairs", language/parse_description.h), whose words that are not understood are kInvalid.
  /// Text vector, similarity field, POIs, path and verification restart; map,
  /// stairs and features stay.
  Result<void> SetGoal(const std::string& goal);

  /// Activates a goal that is a picture: the instance that it shows is to be found, not another
  /// one of its category. Read once, by the suite (perception/goal_picture.h). kInvalid: sides or
  /// box out of limits.
  Result<void> SetGoal(const perception::GoalPicture& picture);

  /// Starts from a saved memory, the lifelong case: the map's states, stairs and features are known
  /// before the first goal. Call before SetGoal. The world frame is the saved one. Errors: another
  /// voxel size or feature dimension.
  Result<void> Restore(geometry::VoxelMap map, memory::SemanticMemory memory,
                       std::vector<geometry::StairFlight> flights = {},
                       const std::vector<geometry::SeenStair>& seen_stairs = {});

  /// Goes on with records of objects that were saved with the memory; after Restore. `day`: runs
  /// with this memory so far (store::MapHeader::revision).
  void RestoreObjects(std::vector<objects::ObjectRecord> records, int day);

  /// One step. Colour with its own grid is first registered to the grid of depth; a mounting in the
  /// observation takes precedence over sensor.camera_height_m. Errors: a malformed observation
  /// (sizes, NaN pose) or a failing network.
  Result<StepResult> Step(const Observation& obs);

  const Config& config() const;
  /// Objects that the agent has records of, those that are gone and places disproved among them:
  /// what is saved with the memory.
  std::vector<objects::ObjectRecord> objects() const;
  /// All records, those of a single frame among them, unordered; until the next step.
  std::span<const objects::ObjectRecord> records() const;
  /// Text vector of the active goal; empty before the first.
  std::span<const float> goal_text() const;
  const geometry::VoxelMap& map() const;
  const memory::SemanticMemory& memory() const;
  /// Known flights: walked flights first, then flights that were only seen.
  const std::vector<geometry::StairFlight>& flights() const;
  /// Voxels that were seen as stairs, walked or not; sorted.
  std::vector<geometry::SeenStair> seen_stairs() const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::agent
