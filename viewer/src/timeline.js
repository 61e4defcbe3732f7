// SPDX-License-Identifier: MIT
// The time line: goals, modes and events along the steps; playing and seeking.
import { logLines, segments, words } from "./data.js";
import { modeColour } from "./panels.js";
import { GOAL_COLOURS } from "./scene.js";

export class Timeline {
  constructor(canvas, replay, onSeek) {
    this.canvas = canvas;
    this.replay = replay;
    this.onSeek = onSeek;
    this.grow();
    canvas.setAttribute("aria-valuemin", "0");
    canvas.onpointerdown = (e) => {
      canvas.setPointerCapture(e.pointerId);
      this.seekTo(e);
    };
    canvas.onpointermove = (e) => {
      if (e.buttons) this.seekTo(e);
      canvas.title = this.describe(this.indexAt(e));
    };
  }

  /// Called after steps were added.
  grow() {
    const { steps } = this.replay;
    this.goals = segments(steps, (s) => s.goal_index);
    this.modes = segments(steps, (s) => s.mode);
    this.marks = logLines(this.replay).filter((line) => line.kind !== "mode");
    this.canvas.setAttribute("aria-valuemax", String(this.count - 1));
  }

  get count() {
    return this.replay.steps.length;
  }

  indexAt(event) {
    const box = this.canvas.getBoundingClientRect();
    const share = (event.clientX - box.left) / Math.max(1, box.width);
    return Math.min(this.count - 1, Math.max(0, Math.floor(share * this.count)));
  }

  seekTo(event) {
    this.onSeek(this.indexAt(event));
  }

  describe(index) {
    const step = this.replay.steps[index];
    return `step ${step.step}: ${words(step.goal)}, ${words(step.mode)}`;
  }

  /// Start of the next or previous goal segment.
  goalFrom(index, direction) {
    const starts = this.goals.map((s) => s.from);
    if (direction > 0) return starts.find((s) => s > index) ?? this.count - 1;
    return [...starts].reverse().find((s) => s < index) ?? 0;
  }

  show(index, colours) {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    const width = box.width, height = box.height;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const c = this.canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    const xOf = (i) => (i / this.count) * width;
    c.font = "600 11px system-ui, sans-serif";
    c.textBaseline = "middle";
    this.drawGoals(c, xOf);
    this.drawModes(c, xOf);
    this.drawMarks(c, xOf, colours);
    const x = xOf(index + 0.5);
    c.fillStyle = colours.text;
    c.fillRect(x - 1, 0, 2, height);
    c.beginPath();
    c.moveTo(x - 5, 0);
    c.lineTo(x + 5, 0);
    c.lineTo(x, 7);
    c.fill();
  }

  drawGoals(c, xOf) {
    for (const { from, to, key } of this.goals) {
      const x = xOf(from), w = xOf(to + 1) - x - 1;
      c.fillStyle = GOAL_COLOURS[key % GOAL_COLOURS.length];
      c.globalAlpha = 0.9;
      c.beginPath();
      c.roundRect(x, 4, w, 18, 3);
      c.fill();
      c.globalAlpha = 1;
      const stage = this.replay.stages.find((s) => s.goal_index === key);
      const sign = stage ? (stage.success ? " ✓" : " ✗") : "";
      const text = `${key + 1} ${words(this.replay.steps[from].goal)}${sign}`;
      c.save();
      c.beginPath();
      c.rect(x, 0, w, 26);
      c.clip();
      c.fillStyle = "#fff";
      c.textAlign = "left";
      c.fillText(text, x + 7, 13.5);
      c.restore();
    }
  }

  drawModes(c, xOf) {
    for (const { from, to, key } of this.modes) {
      c.fillStyle = modeColour(key);
      c.fillRect(xOf(from), 25, Math.max(1, xOf(to + 1) - xOf(from)), 8);
    }
  }

  drawMarks(c, xOf, colours) {
    for (const mark of this.marks) {
      const x = xOf(mark.index + 0.5);
      c.fillStyle = mark.kind === "success" ? "#2f9e44" : mark.kind === "failure" ? "#e03131"
        : colours.muted;
      c.beginPath();
      c.arc(x, 40, mark.kind === "event" ? 2.2 : 4, 0, 2 * Math.PI);
      c.fill();
    }
  }
}
