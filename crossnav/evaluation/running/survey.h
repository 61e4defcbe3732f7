// SPDX-License-Identifier: MIT
// A saved memory that the benchmark makes from the scene itself: ground truth, for the variants
// known-map and known-objects (docs/navigation.md, "What a shorter path would need") and for
// nothing else. Geometry and stairs: what the agent's own mapping makes of views from all over the
// navmesh. Objects: the name of each instance as the feature of its surface voxels. World frame,
// metres. Deterministic.
#pragma once

#include <functional>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::evaluation {

/// What a variant is told before its first step.
enum class Known { kNothing, kMap, kObjects };

/// known-map, known-objects; kNothing for every other variant.
Known KnownOf(const std::string& variant);

struct SceneSurvey {
  geometry::VoxelMap map;
  memory::SemanticMemory memory;  ///< without rows unless objects are known
  std::vector<geometry::StairFlight> flights;
  std::vector<geometry::SeenStair> seen_stairs;
  int places = 0, views = 0;
};

/// Sees each view of a survey, in colour.
using ViewWatcher = std::function<void(const Observation& obs, const InstanceImage& instance)>;

/// Costs some 6 ms a view of 640 x 640, eight views a square metre or so. Errors: objects that are
/// to be known to an encoder of another kind than ground truth's (eval.perception = networks).
Result<SceneSurvey> SurveyScene(const SceneContext& context, const RunConfig& config, Known known,
                                const ViewWatcher& watcher = {});

}  // namespace crossnav::evaluation
