// SPDX-License-Identifier: MIT
// Objects of a graph from the memory: places that match a name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::scenegraph {

/// A category in the space of the memory's features.
struct AskedCategory {
  std::string name;
  std::span<const float> text;
  std::span<const std::vector<float>> background;  ///< for query.relevancy = contrastive
};

/// Adds the places that are not absent by `thresholds`; those that are present are certain. A place
/// on a record of the category adds no second object. Computes no relations.
void FindObjects(SceneGraph& graph, const memory::SemanticMemory& memory,
                 const AskedCategory& category, memory::QueryConfig query,
                 const std::optional<memory::MatchThresholds>& thresholds);

}  // namespace crossnav::scenegraph
