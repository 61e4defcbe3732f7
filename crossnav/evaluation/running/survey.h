// SPDX-License-Identifier: MIT
// Saved memory from ground truth, for the variants known-map and known-objects (docs/navigation.md,
// "What a shorter path would need") only. Geometry and stairs: the agent's own mapping of views
// from all over the navmesh. Objects: the text vector of each instance's name as the feature of its
// surface voxels. World frame, metres. Deterministic.
#pragma once

#include <functional>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::evaluation {

/// Knowledge of a variant before its first step.
enum class Known { kNothing, kMap, kObjects };

/// known-map, known-objects; kNothing for all other variants.
Known KnownOf(const std::string& variant);

struct SceneSurvey {
  geometry::VoxelMap map;
  memory::SemanticMemory memory;  ///< without rows unless objects are known
  std::vector<geometry::StairFlight> flights;
  std::vector<geometry::SeenStair> seen_stairs;
  int places = 0, views = 0;
};

/// Poses of the survey's views, all over the walkable surface.
std::vector<AgentPose> SurveyPoses(const SceneContext& context);

/// Costs some 6 ms a view of 640 x 640, about eight views a square metre. Error: known objects with
/// an encoder other than ground truth's (eval.perception = networks).
/// `on_view` sees every view besides, in colour.
using OnView = std::function<void(const Observation&, const sim::Simulator&)>;
Result<SceneSurvey> SurveyScene(const SceneContext& context, const RunConfig& config, Known known,
                                const OnView& on_view = {});

}  // namespace crossnav::evaluation
