// SPDX-License-Identifier: MIT
#include "crossnav/agent/graph_watch.h"

#include <string>
#include <utility>

namespace crossnav::agent {

std::optional<trace::GraphNote> GraphWatch::Update(const Agent& agent,
                                                   const trace::StepTrace& step) {
  const auto changed = static_cast<std::int64_t>(step.voxel_changes.size());
  if (!live_.Update(agent.map(), agent.memory(), agent.flights(), agent.records(), changed))
    return std::nullopt;
  return NoteOf(live_.graph());
}

trace::GraphNote NoteOf(const scenegraph::SceneGraph& graph) {
  trace::GraphNote note;
  for (const scenegraph::GraphFloor& floor : graph.floors) note.floors_m.push_back(floor.height_m);
  for (const scenegraph::GraphRoom& room : graph.rooms)
    note.rooms.push_back({room.id, graph.floors[static_cast<std::size_t>(room.floor)].height_m,
                          room.area_m2, room.p_center_world, OutlineOf(graph, room)});
  for (const scenegraph::GraphObject& object : graph.objects)
    note.objects.push_back({object.id, object.category, object.room.value_or(-1), object.box});
  for (const scenegraph::GraphRelation& relation : graph.relations)
    note.relations.push_back(
        {std::string(scenegraph::NameOf(relation.kind)), relation.from, relation.to});
  return note;
}

}  // namespace crossnav::agent
