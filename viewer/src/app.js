// SPDX-License-Identifier: MIT
// The page of one replay, or of two: panels, time line, 3D view; draws on demand.
import { OrbitCamera } from "./camera.js";
import { CompareBar } from "./compare.js";
import { fillFloors } from "./controls.js";
import { bytesOfBase64, floorLevels, floorOf, inflate } from "./data.js";
import { GraphPanel } from "./graph.js";
import { INFLATED, WALKABLE } from "./legend.js";
import { Overlay } from "./overlay.js";
import {
  CameraPanel, CandidatesPanel, GoalsHead, LogPanel, StatusPanel, VerificationPanel, byId, make,
  showNotice,
} from "./panels.js";
import { Renderer } from "./renderer.js";
import { SceneBuilder, rgbOf } from "./scene.js";
import { SightLayer } from "./sight.js";
import { Timeline } from "./timeline.js";
import { VoxelHistory, blockFaces } from "./voxels.js";

export class ReplayApp {
  /// `runs`: one replay, or two of the same episode.
  constructor(runs) {
    this.runs = runs;
    this.index = 0;
    this.view = {
      spread: 0, cut: 1.5, floors: "auto", isFollowing: false,
      lowFloor: 0, highFloor: 7,
      layers: {
        trajectory: true, path: true, flights: true, rooms: true, objects: true, relations: false,
        candidates: true, goals: true, other: true,
      },
      isShown: runs[0].states.map((s) => s.is_surface),
    };
    this.camera = new OrbitCamera();
    this.compare = runs.length > 1 ? new CompareBar(this) : null;
    this.useRun(0);
    this.startRenderer();
  }

  /// Sets panels, time line and scene to one of the runs.
  useRun(run) {
    const replay = this.replay = this.runs[run];
    this.run = run;
    this.levels = this.view.levels = floorLevels(replay.steps);
    if (typeof this.view.floors === "number") this.view.floors = "auto";
    this.builder = new SceneBuilder(replay, this.view, this.runs[1 - run]);
    this.overlay = new Overlay(byId("labels"), this.builder);
    const seek = (i) => this.seek(i);
    this.candidates = new CandidatesPanel(replay, (i) => this.highlight(i));
    this.panels = [new CameraPanel(replay), new SightLayer(replay),
      new StatusPanel(replay, this.view), this.candidates,
      new VerificationPanel(replay), new GraphPanel(replay), new LogPanel(replay, seek),
      new GoalsHead(replay, seek)];
    if (this.compare) this.panels.push(this.compare);
    this.timeline = new Timeline(byId("timeline"), replay, seek);
    fillHead(replay);
    fillFloors(this);
  }

  /// Switches to the other run, at the current step and view.
  async switchTo(run) {
    if (run === this.run) return;
    this.play(false);
    this.useRun(run);
    this.renderer?.clearBlocks();
    await this.loadVoxels();
    this.seek(this.index);
  }

  /// Begins a new live run at its first step.
  beginLive(replay) {
    this.play(false);
    this.runs = [replay];
    this.useRun(0);
    this.renderer?.clearBlocks();
    this.voxels = new VoxelHistory();
    this.seek(0);
  }

  /// Called after steps were added to a live run. `pieces`: for each step its voxel runs.
  grow(pieces) {
    const wasAtEnd = this.index >= this.voxels.count - 1;
    for (const runs of pieces) this.voxels.append(runs);
    const levels = floorLevels(this.replay.steps);
    if (levels.join() !== this.levels.join()) {
      this.levels = this.view.levels = levels;
      fillFloors(this);
    }
    for (const panel of [...this.panels, this.timeline]) panel.grow?.();
    if (!wasAtEnd || this.isPlaying) {
      this.showCounter();
      this.redraw();
      return;
    }
    this.seek(Infinity);
    this.voxels.seek(this.index);
    if (!this.hasOwnView) this.keepInView();
  }

  isAtEnd() {
    return this.index === this.replay.steps.length - 1;
  }

  startRenderer() {
    try {
      this.renderer = new Renderer(byId("gl"));
    } catch (error) {
      this.renderer = null;
      const box = byId("view-message");
      box.textContent = `The voxel map cannot be drawn here: ${error.message.replace(/\.$/, "")}. ` +
        "Paths and candidates are shown without it; all other panels work.";
      box.hidden = false;
    }
  }

  async loadVoxels() {
    const { ends, deflated } = this.replay.voxels;
    try {
      const bytes = await inflate(bytesOfBase64(deflated));
      this.voxels = new VoxelHistory(bytes, ends);
    } catch (error) {
      this.voxels = new VoxelHistory(new Uint8Array(0), ends.map(() => 0));
      showNotice(`The voxel map could not be unpacked (${error.message}); a newer browser can.`);
    }
  }

  /// The box of everything, with floors at their current distance: [lo, hi], metres.
  wholeBox() {
    const bounds = this.voxels.bounds(), voxel = this.replay.info.voxel_m;
    const lo = [Infinity, Infinity, Infinity], hi = [-Infinity, -Infinity, -Infinity];
    const add = (p) => p.forEach((v, i) => {
      lo[i] = Math.min(lo[i], v);
      hi[i] = Math.max(hi[i], v);
    });
    for (const step of this.replay.steps) add(this.builder.lift(step.agent.p_world));
    if (bounds) {
      const corners = [bounds.lo, bounds.hi].map((key) => key.map((v) => v * voxel));
      corners.forEach((p) => add([p[0], p[1], Math.min(hi[2], Math.max(lo[2], p[2]))]));
    }
    hi[2] += 1.2;  // walls around the highest place
    return [lo, hi];
  }

  /// Shows everything, if a part is outside the view.
  keepInView() {
    const box = this.wholeBox();
    this.fitCamera(byId("view").getBoundingClientRect());
    if (this.camera.holds(...box)) return;
    const margin = box[0].map((v, i) => 0.1 * (box[1][i] - v));  // or the next step is outside again
    this.camera.frame(...box.map((p, side) => p.map((v, i) => v + (side ? margin[i] : -margin[i]))));
    this.redraw();
  }

  showWhole() {
    this.hasOwnView = false;
    const [lo, hi] = this.wholeBox();
    this.fitCamera(byId("view").getBoundingClientRect());
    this.camera.frame(lo, hi);
    this.redraw();
  }

  seek(index) {
    this.index = Math.min(this.replay.steps.length - 1, Math.max(0, index));
    this.overlay.highlight = -1;
    for (const panel of this.panels) panel.show(this.index);
    this.showCounter();
    this.onSeek?.();
    this.redraw();
  }

  showCounter() {
    const { steps } = this.replay, last = steps[steps.length - 1].step;
    byId("timeline").setAttribute("aria-valuenow", String(this.index));
    byId("counter").textContent = `step ${steps[this.index].step} of ${last}`;
  }

  highlight(candidateIndex) {
    if (this.overlay.highlight === candidateIndex) return;
    this.overlay.highlight = candidateIndex;
    this.candidates.highlight(candidateIndex);
    this.redraw();
  }

  redraw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  fitCamera(box) {
    const dock = byId("dock").offsetWidth;
    this.camera.aspect = box.width / Math.max(1, box.height);
    this.camera.shift = box.width > 2.5 * dock ? dock / box.width : 0;
  }

  updateMesh() {
    this.voxels.seek(this.index);
    for (const block of this.voxels.dirty) {
      this.renderer.setBlock(block, blockFaces(this.voxels, block, this.view.isShown));
    }
    this.voxels.dirty.clear();
  }

  draw() {
    const box = byId("view").getBoundingClientRect();
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const step = this.replay.steps[this.index];
    const colours = themeColours();
    if (this.view.isFollowing) this.camera.target = this.builder.lift(step.agent.p_world);
    this.fitCamera(box);
    const matrix = this.camera.matrix();
    this.updateFloorRange(step);
    const shapes = this.builder.build(this.index);
    if (this.renderer) {
      this.updateMesh();
      this.renderer.resize(box.width, box.height, ratio);
      this.renderer.draw(this.camera.three, {
        ...this.view, background: rgbOf(colours.view),
        voxel_m: this.replay.info.voxel_m,
        colours: this.replay.states.map((s) => s.colour.map((v) => v / 255)),
        walkable: rgbOf(WALKABLE), inflated: rgbOf(INFLATED),
      }, shapes);
    }
    this.overlay.draw({
      width: box.width, height: box.height, ratio, matrix, step, index: this.index,
      view: this.view, colours,
      flatLines: this.renderer ? null : shapes.lines,
    });
    this.timeline.show(this.index, colours);
    document.body.dataset.drawn = String(this.index);
    document.body.dataset.calls = String(this.renderer?.calls ?? 0);
  }

  play(isPlaying) {
    this.isPlaying = isPlaying;
    byId("play").textContent = isPlaying ? "❚❚ Pause" : "▶ Play";
    if (!isPlaying) return;
    if (this.index === this.replay.steps.length - 1) this.seek(0);
    const start = performance.now(), first = this.index;
    const tick = (now) => {
      if (!this.isPlaying || this.playToken !== token) return;
      const rate = Number(byId("speed").value);
      const due = first + Math.floor(((now - start) / 1000) * rate);
      if (due !== this.index) this.seek(due);
      if (this.index === this.replay.steps.length - 1) this.play(false);
      else requestAnimationFrame(tick);
    };
    const token = (this.playToken = {});
    requestAnimationFrame(tick);
  }

  lookFromTop() {
    this.camera.pitch = 1.5707;
    this.camera.yaw = -Math.PI / 2;
    this.showWhole();
  }

  /// "auto" (the robot's floor and the floors below it), "all", or the number of a floor.
  showFloors(which) {
    this.view.floors = this.view.floors === which ? "auto" : which;
    for (const button of byId("floors").children) {
      button.classList.toggle("on", button.dataset.floors === String(this.view.floors));
    }
    this.redraw();
  }

  updateFloorRange(step) {
    const { floors, levels } = this.view, last = Math.max(0, levels.length - 1);
    const isNumber = typeof floors === "number";
    const highest = floors === "auto" ? floorOf(levels, step.agent.p_world[2]) : last;
    this.view.lowFloor = isNumber ? floors : 0;
    this.view.highFloor = isNumber ? floors : highest;
  }

  toggleFollow() {
    this.view.isFollowing = !this.view.isFollowing;
    byId("follow").classList.toggle("on", this.view.isFollowing);
    this.redraw();
  }
}

function themeColours() {
  const style = getComputedStyle(document.documentElement);
  const get = (name) => style.getPropertyValue(name).trim();
  return { view: get("--view"), text: get("--text"), muted: get("--muted"), halo: get("--halo") };
}

export function fillHead(replay) {
  const { scene_id, episode_id, variant, perception, seed } = replay.info;
  const parts = [["scene", scene_id], ["episode", episode_id], ["variant", variant],
    ["perception", perception], ["seed", String(seed)]];
  byId("episode").replaceChildren(...parts.filter(([, v]) => v !== "").map(
    ([k, v]) => make("span", "", [make("i", "", k), ` ${v}`])));
  document.title = `${scene_id} ${episode_id} – crossnav replay`;
}
