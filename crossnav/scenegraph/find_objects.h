// SPDX-License-Identifier: MIT
// Objects of a graph as the memory answers for them: places at which it matches a name.
#pragma once

#include <span>
#include <string>
#include <string_view>
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

/// Adds the places that match as well as what is present; all of them where that was never measured
/// for the encoder of this name (memory/query_match.h). Their relations are not made yet.
void FindObjects(SceneGraph& graph, const memory::SemanticMemory& memory,
                 const AskedCategory& category, memory::QueryConfig query,
                 std::string_view encoder_name);

}  // namespace crossnav::scenegraph
