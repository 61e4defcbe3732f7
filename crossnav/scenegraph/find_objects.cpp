// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/find_objects.h"

#include <algorithm>

#include "crossnav/core/category_table.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::scenegraph {
namespace {

/// Whether a record of the category lies at the place.
bool IsRecorded(const SceneGraph& graph, const std::string& category, const Box3& box) {
  return std::any_of(graph.objects.begin(), graph.objects.end(), [&](const auto& object) {
    return object.record >= 0 && CanonicalName(object.category) == CanonicalName(category) &&
           (object.box.min.array() <= box.max.array()).all() &&
           (object.box.max.array() >= box.min.array()).all();
  });
}

}  // namespace

void FindObjects(SceneGraph& graph, const memory::SemanticMemory& memory,
                 const AskedCategory& category, memory::QueryConfig query,
                 const std::optional<memory::MatchThresholds>& thresholds) {
  query.top_k = 1000;  // every match
  const auto found = memory::Query(memory, category.text, query, category.background);
  const auto match = memory::MatchOf(memory, category.text, found);
  graph.asked.push_back(category.name);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (thresholds && match.places[i] < thresholds->absent_below) continue;
    if (IsRecorded(graph, category.name, found[i].box)) continue;
    GraphObject object;
    object.category = category.name;
    object.p_center_world = found[i].p_center_world;
    object.box = found[i].box;
    object.match = match.places[i];
    object.is_certain = thresholds && match.places[i] >= thresholds->present_from;
    AddObject(graph, std::move(object));
  }
}

}  // namespace crossnav::scenegraph
