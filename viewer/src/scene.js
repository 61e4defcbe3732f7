// SPDX-License-Identifier: MIT
// The 3D view's content at a step: lines in world metres, and the robot's pose. Applies the spread
// of floors by the same rule as the renderer's shader.
import { flightsAt, floorOf, graphAt } from "./data.js";

export const GOAL_COLOURS = ["#1c7ed6", "#e8590c", "#9c36b5", "#2b8a3e", "#c2255c", "#0b7285"];
export const MODE_COLOURS = {
  basic_explore: "#4c8bd0",
  stair_explore: "#e8930c",
  poi_navigation: "#9c5fc4",
  target_approach: "#d6457b",
};
export const KINDS = {
  live_poi: { label: "live POI", mark: "L", colour: "#d6336c" },
  history_poi: { label: "history POI", mark: "H", colour: "#9c36b5" },
  traversable_frontier: { label: "frontier", mark: "F", colour: "#1c7ed6" },
  descend_frontier: { label: "descent", mark: "D", colour: "#c2410c" },
  ascent_frontier: { label: "ascent", mark: "A", colour: "#b7791f" },
  stair_frontier: { label: "stair frontier", mark: "S", colour: "#0b7285" },
  sighting: { label: "weak sighting", mark: "W", colour: "#e8590c" },
  uninspected: { label: "not inspected", mark: "U", colour: "#5f3dc4" },
  search_view: { label: "search view", mark: "V", colour: "#2b8a3e" },
  closed_way: { label: "closed way", mark: "C", colour: "#862e9c" },
};
const OTHER_KIND = { mark: "?", colour: "#868e96" };
export const PATH_COLOUR = "#0ca678";
export const OTHER_RUN_COLOUR = "#868e96";
export const FLIGHT_COLOUR = "#5f3a12";
export const ROOM_COLOUR = "#7048e8";
export const OBJECT_COLOUR = "#0c8599";
export const RELATION_COLOUR = "#f08c00";
export const GOAL_COLOUR = "#2f9e44";
export const OTHER_GOAL_COLOUR = "#5c6773";

export function kindOf(name) {
  return KINDS[name] || { ...OTHER_KIND, label: name.replace(/_/g, " ") };
}

export function rgbOf(hex) {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
}

export class SceneBuilder {
  /// view: {levels, spread, lowFloor, highFloor, layers}; read at each build. `other`: a second
  /// replay of the episode, or undefined.
  constructor(replay, view, other) {
    this.replay = replay;
    this.view = view;
    this.other = other;
  }

  lift(p) {
    return [p[0], p[1], p[2] + floorOf(this.view.levels, p[2]) * this.view.spread];
  }

  isShown(p) {
    const floor = floorOf(this.view.levels, p[2]);
    return floor >= this.view.lowFloor && floor <= this.view.highFloor;
  }

  /// {lines: number[], robot: {p_world, yaw_rad} | null}
  build(index) {
    const out = { lines: [], robot: null };
    const step = this.replay.steps[index];
    const layers = this.view.layers;
    if (layers.goals) this.addGoals(out, step);
    if (layers.other && this.other) this.addOther(out, index);
    if (layers.trajectory) this.addTrajectory(out, index);
    if (layers.flights) this.addFlights(out, index);
    this.addGraph(out, graphAt(this.replay, index));
    if (layers.path) this.addPath(out, step);
    this.addAgent(out, step);
    return out;
  }

  addLine(out, p, q, rgb, alpha, width) {
    if (this.isShown(p) || this.isShown(q)) this.addAnyLine(out, p, q, rgb, alpha, width);
  }

  addAnyLine(out, p, q, rgb, alpha, width) {
    out.lines.push(...this.lift(p), ...this.lift(q), ...rgb, alpha, width);
  }

  addTrajectory(out, index) {
    this.addWalk(out, this.replay.steps, index, 0.12, 3.2,
      (step) => GOAL_COLOURS[step.goal_index % GOAL_COLOURS.length]);
  }

  /// Below this run's own path, so that equal parts appear as one line.
  addOther(out, index) {
    this.addWalk(out, this.other.steps, index, 0.1, 5, () => OTHER_RUN_COLOUR);
  }

  addWalk(out, steps, index, height_m, width, colourOf) {
    for (let i = 1; i <= Math.min(index, steps.length - 1); ++i) {
      const from = above(steps[i - 1].agent.p_world, height_m);
      const to = above(steps[i].agent.p_world, height_m);
      if (from.every((v, axis) => v === to[axis])) continue;
      this.addLine(out, from, to, rgbOf(colourOf(steps[i])), 1, width);
    }
  }

  addPath(out, step) {
    const path = step.path_world;
    for (let i = 1; i < path.length; ++i) {
      this.addAnyLine(out, above(path[i - 1], 0.02), above(path[i], 0.02), rgbOf(PATH_COLOUR), 1, 4);
    }
  }

  /// Walked flights thick; flights that were only seen thin.
  addFlights(out, index) {
    for (const flight of flightsAt(this.replay.steps, index)) {
      const isWalked = flight.walked_up + flight.walked_down > 0, p = flight.steps_world;
      for (let i = 1; i < p.length; ++i) {
        this.addLine(out, above(p[i - 1], 0.06), above(p[i], 0.06), rgbOf(FLIGHT_COLOUR),
          isWalked ? 1 : 0.7, isWalked ? 5 : 2);
      }
    }
  }

  /// Rooms as outlines on their floor, objects as boxes, relations as lines between these.
  addGraph(out, graph) {
    if (!graph) return;
    const { rooms, objects, relations } = this.view.layers;
    for (const room of rooms ? graph.rooms : []) {
      const z = room.height_m + 0.04;
      for (const [x0, y0, x1, y1] of room.outline) {
        this.addLine(out, [x0, y0, z], [x1, y1, z], rgbOf(ROOM_COLOUR), 0.9, 2.2);
      }
    }
    for (const object of objects ? graph.objects : []) {
      for (const [p, q] of boxEdges(object.box_min, object.box_max)) {
        this.addLine(out, p, q, rgbOf(OBJECT_COLOUR), 0.9, 1.6);
      }
    }
    const byId = new Map(graph.objects.map((object) => [object.id, object]));
    for (const { from, to } of relations ? graph.relations : []) {
      const [a, b] = [byId.get(from), byId.get(to)];
      if (a && b) this.addLine(out, middleOf(a), middleOf(b), rgbOf(RELATION_COLOUR), 0.9, 1.8);
    }
  }

  addGoals(out, step) {
    for (const instance of this.replay.info.goal_instances) {
      const isCurrent = instance.goal === step.goal;
      const rgb = rgbOf(isCurrent ? GOAL_COLOUR : OTHER_GOAL_COLOUR);
      for (const [p, q] of boxEdges(instance.box_min, instance.box_max)) {
        if (isCurrent) this.addAnyLine(out, p, q, rgb, 1, 2.6);
        else this.addLine(out, p, q, rgb, 0.7, 1.4);
      }
    }
  }

  addAgent(out, step) {
    const { p_world: foot, yaw_rad: yaw } = step.agent;
    if (!this.isShown(foot)) return;
    const base = this.lift(foot);
    out.robot = { p_world: base, yaw_rad: yaw };
    const rgb = rgbOf("#ffb700");
    for (const [p, q] of frustumEdges(step.T_world_camera)) {
      const rise = base[2] - foot[2];
      out.lines.push(...above(p, rise), ...above(q, rise), ...rgb, 0.9, 1.6);
    }
  }
}

export function above(p, height) {
  return [p[0], p[1], p[2] + height];
}

export function middleOf(object) {
  return object.box_min.map((v, i) => (v + object.box_max[i]) / 2);
}

function boxEdges(lo, hi) {
  const corner = (i) => [i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]];
  const edges = [];
  for (let i = 0; i < 8; ++i) {
    for (const bit of [1, 2, 4]) if (!(i & bit)) edges.push([corner(i), corner(i | bit)]);
  }
  return edges;
}

/// The camera's view as a small pyramid. T: twelve numbers, rows of the camera-to-world matrix.
function frustumEdges(T) {
  const toWorld = (p) => [0, 1, 2].map(
    (r) => T[4 * r] * p[0] + T[4 * r + 1] * p[1] + T[4 * r + 2] * p[2] + T[4 * r + 3]);
  const d = 0.55, h = 0.5 * d;
  const tip = toWorld([0, 0, 0]);
  const rim = [[-h, -h, d], [h, -h, d], [h, h, d], [-h, h, d]].map(toWorld);
  const edges = [];
  for (let i = 0; i < 4; ++i) edges.push([tip, rim[i]], [rim[i], rim[(i + 1) % 4]]);
  return edges;
}
