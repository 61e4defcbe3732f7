// SPDX-License-Identifier: MIT
// Puts the page together: reads the embedded data, draws on demand, listens to keys and pointer.
import { OrbitCamera } from "./camera.js";
import { CompareBar } from "./compare.js";
import { connectKeys, connectPointer, connectTools, fillFloors } from "./controls.js";
import { bytesOfBase64, floorLevels, floorOf, inflate, openingOf, words } from "./data.js";
import { Overlay } from "./overlay.js";
import {
  CameraPanel, CandidatesPanel, GoalsHead, LogPanel, StatusPanel, VerificationPanel, byId, make,
} from "./panels.js";
import { Renderer } from "./renderer.js";
import { FLIGHT_COLOUR, KINDS, OTHER_RUN_COLOUR, PATH_COLOUR, SceneBuilder, rgbOf } from "./scene.js";
import { SightLayer } from "./sight.js";
import { Timeline } from "./timeline.js";
import { VoxelHistory, blockFaces } from "./voxels.js";

const WALKABLE = "#b9dcc0", INFLATED = "#dccfb8";
const LAYERS = [
  ["trajectory", "trajectory, by goal", "#1c7ed6"],
  ["path", "planned path", PATH_COLOUR],
  ["flights", "flights of stairs", FLIGHT_COLOUR],
  ["candidates", "candidates and target", "#e64980"],
  ["goals", "true goals (agent unaware)", "#2f9e44"],
  ["other", "where the other run went", OTHER_RUN_COLOUR],
];

class ReplayApp {
  /// `runs`: one replay, or two of the same episode.
  constructor(runs) {
    this.runs = runs;
    this.index = 0;
    this.view = {
      spread: 0, cut: 1.5, floors: "auto", isFollowing: false,
      lowFloor: 0, highFloor: 7,
      layers: { trajectory: true, path: true, flights: true, candidates: true, goals: true, other: true },
      isShown: runs[0].states.map((s) => s.is_surface),
    };
    this.camera = new OrbitCamera();
    this.compare = runs.length > 1 ? new CompareBar(this) : null;
    this.useRun(0);
    this.startRenderer();
  }

  /// Panels, time line and scene of one of the runs.
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
      new StatusPanel(replay, this.levels), this.candidates,
      new VerificationPanel(replay), new LogPanel(replay, seek), new GoalsHead(replay, seek)];
    if (this.compare) this.panels.push(this.compare);
    this.timeline = new Timeline(byId("timeline"), replay, seek);
    fillHead(replay);
    fillFloors(this);
  }

  /// The other run, at the step and from the place that are shown now.
  async switchTo(run) {
    if (run === this.run) return;
    this.play(false);
    this.useRun(run);
    this.renderer?.clearBlocks();
    await this.loadVoxels();
    this.seek(this.index);
  }

  startRenderer() {
    try {
      this.renderer = new Renderer(byId("gl"));
    } catch (error) {
      this.renderer = null;
      const box = byId("view-message");
      box.textContent = `The voxel map cannot be drawn here: ${error.message}. ` +
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

  showWhole() {
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
    this.fitCamera(byId("view").getBoundingClientRect());
    this.camera.frame(lo, hi);
    this.redraw();
  }

  seek(index) {
    this.index = Math.min(this.replay.steps.length - 1, Math.max(0, index));
    this.overlay.highlight = -1;
    for (const panel of this.panels) panel.show(this.index);
    const last = this.replay.steps[this.replay.steps.length - 1].step;
    byId("timeline").setAttribute("aria-valuenow", String(this.index));
    byId("counter").textContent = `step ${this.replay.steps[this.index].step} of ${last}`;
    this.redraw();
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
      width: box.width, height: box.height, ratio, matrix, step, view: this.view, colours,
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

  /// "auto" (the robot's floor and what is below it), "all", or the number of one floor.
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

function showNotice(text) {
  const notice = byId("notice");
  notice.textContent = notice.hidden ? text : `${notice.textContent} ${text}`;
  notice.hidden = false;
}

function fillHead(replay) {
  const { scene_id, episode_id, variant, perception, seed } = replay.info;
  const parts = [["scene", scene_id], ["episode", episode_id], ["variant", variant],
    ["perception", perception], ["seed", String(seed)]];
  byId("episode").replaceChildren(...parts.filter(([, v]) => v !== "").map(
    ([k, v]) => make("span", "", [make("i", "", k), ` ${v}`])));
  document.title = `${scene_id} ${episode_id} – crossnav replay`;
}

/// A box to tick with a colour and a name.
function legendRow(colour, name, isOn, onChange) {
  const box = make("input");
  box.type = "checkbox";
  box.checked = isOn;
  box.addEventListener("change", () => onChange(box.checked));
  const patch = make("i", "patch");
  patch.style.background = colour;
  return make("label", "", [box, patch, make("span", "", name)]);
}

function fillLegend(app) {
  const { replay, view } = app;
  const cssOf = (rgb) => `rgb(${rgb.join(",")})`;
  const states = replay.states.map((state, i) => ({ ...state, i })).filter((s) => s.i > 0);
  byId("legend-states").replaceChildren(...states.map((state) => {
    const suffix = state.is_surface ? "" : " (air)";
    return legendRow(cssOf(state.colour), words(state.name.toLowerCase()) + suffix,
      view.isShown[state.i], (isOn) => {
        view.isShown[state.i] = isOn;
        app.voxels.markAllDirty();
        app.redraw();
      });
  }), patchRow(WALKABLE, "floor that can be walked"), patchRow(INFLATED, "floor too near an obstacle"));
  byId("legend-layers").replaceChildren(...LAYERS.filter(([key]) => key !== "other" || app.compare).map(([key, name, colour]) =>
    legendRow(colour, name, true, (isOn) => {
      view.layers[key] = isOn;
      app.redraw();
    })), make("div", "marks", Object.values(KINDS).map((kind) => {
    const dot = make("b", "", kind.mark);
    dot.style.background = kind.colour;
    return make("span", "", [dot, kind.label]);
  })));
}

function patchRow(colour, name) {
  const patch = make("i", "patch");
  patch.style.background = colour;
  return make("label", "fixed", [patch, make("span", "", name)]);
}

/// "#step=120&floors=2&top": a view that can be linked to.
function applyHash(app) {
  const wanted = new URLSearchParams(location.hash.slice(1));
  if (wanted.has("theme")) document.documentElement.dataset.theme = wanted.get("theme");
  const floors = wanted.get("floors");
  if (floors) app.showFloors(/^\d+$/.test(floors) ? Number(floors) - 1 : floors);
  if (wanted.has("spread")) byId("spread").value = wanted.get("spread");
  byId("spread").dispatchEvent(new Event("input"));
  if (wanted.has("spread")) app.showWhole();
  if (wanted.has("top")) app.lookFromTop();
  const step = wanted.get("step");
  const opening = app.compare ? app.compare.opening() : openingOf(app.replay);
  app.seek(step === null ? opening.index : app.replay.steps.findIndex((s) => s.step >= Number(step)));
  if (step === null && opening.text) showNotice(opening.text);
}

/// The replay in an element of the page, or null: none is there, or it cannot be read.
function embedded(id) {
  try {
    return JSON.parse(byId(id).textContent);
  } catch (error) {
    showNotice(`The page is damaged, its replay cannot be read (${error.message}). Export it again.`);
    return null;
  }
}

async function start() {
  const runs = [embedded("replay-data"), embedded("other-data")].filter((replay) => replay);
  if (runs.length === 0) return;
  if (runs.some((replay) => !replay.is_complete)) {
    showNotice("The replay was cut off: it ends where the recording stopped.");
  }
  if (runs.some((replay) => replay.steps.length === 0)) {
    fillHead(runs[0]);
    showNotice("The replay holds no step.");
    return;
  }
  const app = new ReplayApp(runs);
  await app.loadVoxels();
  app.showWhole();
  connectTools(app);
  connectKeys(app);
  connectPointer(app);
  fillLegend(app);
  new ResizeObserver(() => app.redraw()).observe(byId("view"));
  applyHash(app);
}

if (typeof document !== "undefined") start();
