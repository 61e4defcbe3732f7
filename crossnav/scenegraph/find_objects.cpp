// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/find_objects.h"

#include "crossnav/memory/query_match.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::scenegraph {

void FindObjects(SceneGraph& graph, const memory::SemanticMemory& memory,
                 const AskedCategory& category, memory::QueryConfig query,
                 std::string_view encoder_name) {
  query.top_k = 1000;  // all that stand out
  const auto found = memory::Query(memory, category.text, query, category.background);
  const auto match = memory::MatchOf(memory, category.text, found);
  const auto from = memory::PresentFrom(encoder_name);
  graph.asked.push_back(category.name);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (from && match.places[i] < *from) continue;
    GraphObject object;
    object.category = category.name;
    object.p_center_world = found[i].p_center_world;
    object.box = found[i].box;
    object.match = match.places[i];
    object.is_certain = from.has_value();
    AddObject(graph, std::move(object));
  }
}

}  // namespace crossnav::scenegraph
