// SPDX-License-Identifier: MIT
// Scores the scene graph of a generated house's map against the house's plan.
#pragma once

#include <cstdint>
#include <memory>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/evaluation/trials/graph_objects.h"
#include "crossnav/scenegraph/scene_graph.h"
#include "crossnav/world/layout/house_params.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::evaluation {

struct GraphScore {
  int floors = 0, floors_found = 0, floors_wrong = 0;  ///< of the plan; found; in addition
  int rooms = 0, rooms_found = 0, rooms_wrong = 0;     ///< likewise, by IoU of at least 0.5

  double RoomsF1() const {
    const int all = 2 * rooms_found + rooms_wrong + (rooms - rooms_found);
    return all > 0 ? 2.0 * rooms_found / all : 0;
  }
  GraphScore& operator+=(const GraphScore& other);
};

/// Rooms of the plan without a wall between them count as one; voids are none. Parts of a room
/// without floor are left out.
GraphScore ScoreGraph(const scenegraph::SceneGraph& graph, const world::HousePlan& plan);

struct GraphTrial {
  std::string house;
  GraphScore score;
  scenegraph::SceneGraph graph;
  ObjectScore objects;
  double seconds = 0;    ///< of BuildGraph, wall clock
  double record_ms = 0;  ///< of the records of objects, for each view
  double relate_ms = 0;  ///< of AddRecords and RelateObjects
};

/// The first plan that passes the gate, and the scene built from it.
Result<world::HousePlan> PassedPlan(const world::HouseParams& params, const RunConfig& config,
                                    std::unique_ptr<SceneContext>& context);

/// House `seed` of edition 1 or 2 as the generator draws it, its survey
/// (evaluation/running/survey.h), its graph. With `suite`, objects come from its detections in
/// colour pictures of the house.
Result<GraphTrial> TryGraph(std::uint64_t seed, int edition, const RunConfig& config,
                            perception::PerceptionSuite* suite = nullptr);

}  // namespace crossnav::evaluation
