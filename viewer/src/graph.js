// SPDX-License-Identifier: MIT
// The scene graph as a list: floors, their rooms, the objects in these with their relations.
import { figure, graphAt, words } from "./data.js";
import { byId, make } from "./panels.js";

/// "on table 3, near sofa 5", from the object's point of view.
function relationsOf(object, graph, nameOf) {
  return graph.relations.filter((relation) => relation.from === object.id)
    .map((relation) => `${relation.kind} ${nameOf(relation.to)}`).join(", ");
}

export class GraphPanel {
  constructor(replay) {
    this.replay = replay;
    this.shown = undefined;
  }

  show(index) {
    const graph = graphAt(this.replay, index);
    if (graph === this.shown) return;
    this.shown = graph;
    byId("graph-section").hidden = !graph;
    if (!graph) return;
    byId("graph-count").textContent =
      `${graph.rooms.length} rooms, ${graph.objects.length} objects, ${graph.relations.length} relations`;
    byId("graph").replaceChildren(...graph.floors_m.flatMap((height, floor) => [
      make("h3", "", `floor ${floor + 1}, ${figure(height, 1)} m`),
      ...graph.rooms.filter((room) => room.height_m === height).map((room) => this.room(room, graph)),
    ]), ...this.rest(graph));
  }

  room(room, graph) {
    const objects = graph.objects.filter((object) => object.room === room.id);
    return make("div", "room", [
      make("b", "", `room ${room.id}`), make("span", "muted", ` ${figure(room.area_m2, 1)} m²`),
      this.list(objects, graph)]);
  }

  /// Objects without a room.
  rest(graph) {
    const ids = new Set(graph.rooms.map((room) => room.id));
    const objects = graph.objects.filter((object) => !ids.has(object.room));
    if (!objects.length) return [];
    return [make("div", "room", [make("b", "", "in no room"), this.list(objects, graph)])];
  }

  list(objects, graph) {
    const names = new Map(graph.objects.map((o) => [o.id, `${words(o.category)} ${o.id}`]));
    return make("ul", "", objects.map((object) => {
      const relations = relationsOf(object, graph, (id) => names.get(id) || "?");
      return make("li", "", [make("span", "", names.get(object.id)),
        make("span", "muted", relations && ` ${relations}`)]);
    }));
  }
}
