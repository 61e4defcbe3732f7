// SPDX-License-Identifier: MIT
// Objects of a graph as the memory answers for them: places at which it matches a name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::scenegraph {

/// A category in the space of the memory's features.
struct AskedCategory {
  std::string name;
  std::span<const float> text;
  std::span<const std::vector<float>> background;  ///< for query.relevancy = contrastive
};

/// Adds the places that match at least as well as `present_from` (memory/query_match.h); all of
/// them where it is not known. A place on a record of the category is no second object. Relations
/// are not made yet.
void FindObjects(SceneGraph& graph, const memory::SemanticMemory& memory,
                 const AskedCategory& category, memory::QueryConfig query,
                 std::optional<double> present_from);

}  // namespace crossnav::scenegraph
