// SPDX-License-Identifier: MIT
// Labels over the 3D view: candidates, target, goals, floors. Without WebGL it also draws the
// lines, so that the page shows the robot's path.
import { projectPoint } from "./camera.js";
import { graphAt, words } from "./data.js";
import { LINE_FLOATS } from "./renderer.js";
import {
  GOAL_COLOUR, OBJECT_COLOUR, OTHER_GOAL_COLOUR, ROOM_COLOUR, above, kindOf, middleOf,
} from "./scene.js";

export class Overlay {
  constructor(canvas, builder) {
    this.canvas = canvas;
    this.builder = builder;
    this.spots = [];  // targets of the pointer: {x, y, radius, candidate}
    this.highlight = -1;
  }

  draw(frame) {
    const { width, height, ratio, matrix, step, index, view, colours } = frame;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const c = this.canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = "600 11px system-ui, sans-serif";
    c.textBaseline = "middle";
    this.spots = [];
    this.context = c;
    this.colours = colours;
    this.project = (p) => projectPoint(matrix, this.builder.lift(p), width, height);
    if (frame.flatLines) drawFlat(c, frame.flatLines, matrix, width, height);
    this.drawGraph(graphAt(this.builder.replay, index), view.layers);
    if (view.layers.goals) this.drawGoals(step);
    if (view.layers.candidates) this.drawCandidates(step);
    if (!view.layers.candidates) this.drawTarget(step);
  }

  drawGoals(step) {
    for (const instance of this.builder.replay.info.goal_instances) {
      const centre = instance.box_min.map((v, i) => (v + instance.box_max[i]) / 2);
      const isCurrent = instance.goal === step.goal;
      if (!isCurrent && !this.builder.isShown(centre)) continue;
      const at = this.project([centre[0], centre[1], instance.box_max[2] + 0.15]);
      const colour = isCurrent ? GOAL_COLOUR : OTHER_GOAL_COLOUR;
      if (at) this.tag(at, instance.goal.replace(/_/g, " "), colour);
    }
  }

  drawGraph(graph, layers) {
    const name = (p, text, colour) => {
      const at = this.builder.isShown(p) && this.project(p);
      if (at) this.tag(at, text, colour);
    };
    for (const room of (graph && layers.rooms) ? graph.rooms : []) {
      name(room.center, `room ${room.id}`, ROOM_COLOUR);
    }
    for (const object of (graph && layers.objects) ? graph.objects : []) {
      const [x, y] = middleOf(object);
      name([x, y, object.box_max[2] + 0.1], words(object.category), OBJECT_COLOUR);
    }
  }

  drawTarget(step) {
    step.candidates.forEach((candidate, i) => {
      if (candidate.is_target) this.drawCandidate(candidate, i);
    });
  }

  drawCandidates(step) {
    // Draws the target last, on top.
    step.candidates.forEach((c, i) => { if (!c.is_target) this.drawCandidate(c, i); });
    this.drawTarget(step);
  }

  drawCandidate(candidate, index) {
    if (!candidate.is_target && !this.builder.isShown(candidate.p_nav_world)) return;
    const at = this.project(candidate.p_nav_world);
    if (!at) return;
    const c = this.context, kind = kindOf(candidate.kind);
    const radius = candidate.is_target ? 9 : 7;
    this.drawFocus(candidate, at, kind.colour);
    c.globalAlpha = candidate.is_reachable ? 1 : 0.45;
    disc(c, at, radius + 1.5, this.colours.halo);
    disc(c, at, radius, kind.colour);
    c.fillStyle = "#fff";
    c.textAlign = "center";
    c.fillText(kind.mark, at[0], at[1] + 0.5);
    c.globalAlpha = 1;
    if (candidate.is_target || index === this.highlight) {
      ring(c, at, radius + 4, candidate.is_target ? "#0ca678" : kind.colour);
      const prefix = candidate.is_target ? "target: " : "";
      this.tag([at[0], at[1] - radius - 14], prefix + kind.label, kind.colour);
    }
    this.spots.push({ x: at[0], y: at[1], radius: radius + 4, index, candidate });
  }

  drawFocus(candidate, at, colour) {
    const apart = candidate.p_focus_world.some((v, i) => Math.abs(v - candidate.p_nav_world[i]) > 0.3);
    const focus = apart && this.project(above(candidate.p_focus_world, 0));
    if (!focus) return;
    const c = this.context;
    c.strokeStyle = colour;
    c.lineWidth = 1.2;
    c.setLineDash([3, 3]);
    c.beginPath();
    c.moveTo(...at);
    c.lineTo(...focus);
    c.stroke();
    c.setLineDash([]);
    disc(c, focus, 3, colour);
  }

  tag(at, text, colour) {
    const c = this.context;
    const width = c.measureText(text).width + 12;
    c.fillStyle = colour;
    c.globalAlpha = 0.92;
    c.beginPath();
    c.roundRect(at[0] - width / 2, at[1] - 9, width, 18, 4);
    c.fill();
    c.globalAlpha = 1;
    c.fillStyle = "#fff";
    c.textAlign = "center";
    c.fillText(text, at[0], at[1] + 0.5);
  }

  /// The candidate under the pointer, or null.
  spotAt(x, y) {
    const near = this.spots.filter((s) => Math.hypot(s.x - x, s.y - y) <= s.radius);
    return near.length ? near[near.length - 1] : null;
  }
}

function disc(c, at, radius, colour) {
  c.fillStyle = colour;
  c.beginPath();
  c.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  c.fill();
}

function ring(c, at, radius, colour) {
  c.strokeStyle = colour;
  c.lineWidth = 2.5;
  c.beginPath();
  c.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  c.stroke();
}

function drawFlat(c, lines, matrix, width, height) {
  for (let i = 0; i < lines.length; i += LINE_FLOATS) {
    const p = projectPoint(matrix, lines.slice(i, i + 3), width, height);
    const q = projectPoint(matrix, lines.slice(i + 3, i + 6), width, height);
    if (!p || !q) continue;
    const rgb = lines.slice(i + 6, i + 9).map((v) => Math.round(255 * v));
    c.strokeStyle = `rgb(${rgb})`;
    c.lineWidth = lines[i + 10];
    c.beginPath();
    c.moveTo(...p);
    c.lineTo(...q);
    c.stroke();
  }
}
