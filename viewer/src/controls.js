// SPDX-License-Identifier: MIT
// Buttons, keys and pointer of the page, connected once.
import { figure } from "./data.js";
import { byId, make } from "./panels.js";
import { kindOf } from "./scene.js";

/// Makes a button for each floor of the current run.
export function fillFloors(app) {
  const floors = [["Auto", "auto", "the robot's floor and what is below it"], ["All", "all", ""],
    ...app.levels.map((level, i) => [String(i + 1), i, `the floor at ${level.toFixed(2)} m alone`])];
  byId("floors").replaceChildren(...floors.map(([name, which, title]) => {
    const button = make("button", which === "auto" ? "on" : "", name);
    button.dataset.floors = String(which);
    button.title = title;
    button.addEventListener("click", () => app.showFloors(which));
    return button;
  }));
  byId("floors-row").hidden = byId("spread-row").hidden = app.levels.length < 2;
}

export function connectTools(app) {
  const slider = (id, apply) => {
    const update = () => {
      const value = Number(byId(id).value);
      byId(`${id}-value`).textContent = `${value.toFixed(1)} m`;
      apply(value);
      app.redraw();
    };
    byId(id).addEventListener("input", update);
    update();
  };
  slider("cut", (v) => { app.view.cut = v; });
  slider("spread", (v) => { app.view.spread = v; });
  byId("from-top").addEventListener("click", () => app.lookFromTop());
  byId("whole").addEventListener("click", () => app.showWhole());
  byId("follow").addEventListener("click", () => app.toggleFollow());
  byId("back").addEventListener("click", () => app.seek(app.index - 1));
  byId("forth").addEventListener("click", () => app.seek(app.index + 1));
  byId("play").addEventListener("click", () => app.play(!app.isPlaying));
  byId("speed").addEventListener("change", () => { if (app.isPlaying) app.play(true); });
  byId("help-button").addEventListener("click", () => byId("help").showModal());
  byId("theme").addEventListener("click", () => {
    const root = document.documentElement;
    const isDark = getComputedStyle(root).colorScheme === "dark";
    root.dataset.theme = isDark ? "light" : "dark";
    app.redraw();
  });
}

export function connectKeys(app) {
  const actions = {
    " ": () => app.play(!app.isPlaying),
    ArrowLeft: (e) => app.seek(app.index - (e.shiftKey ? 10 : 1)),
    ArrowRight: (e) => app.seek(app.index + (e.shiftKey ? 10 : 1)),
    Home: () => app.seek(0),
    End: () => app.seek(Infinity),
    "[": () => app.seek(app.timeline.goalFrom(app.index, -1)),
    "]": () => app.seek(app.timeline.goalFrom(app.index, 1)),
    "?": () => byId("help").showModal(),
    t: () => app.lookFromTop(),
    f: () => app.toggleFollow(),
    l: () => app.seek(Infinity),
    0: () => app.showWhole(),
  };
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
    if (event.target.matches("input, select")) return;
    const floor = Number(event.key) - 1;
    const isFloor = /^[1-9]$/.test(event.key) && floor < app.levels.length;
    const action = isFloor ? () => app.showFloors(floor) : actions[event.key] ||
      actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

export function connectPointer(app) {
  const canvas = byId("labels"), tooltip = byId("tooltip");
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("pointerdown", (e) => canvas.setPointerCapture(e.pointerId));
  canvas.addEventListener("pointermove", (e) => {
    const box = canvas.getBoundingClientRect();
    if (e.buttons) {
      app.hasOwnView = true;
      if (e.shiftKey || e.buttons & 6) app.camera.pan(e.movementX, e.movementY, box.height);
      else app.camera.orbit(e.movementX, e.movementY);
      app.redraw();
      return;
    }
    const spot = app.overlay.spotAt(e.clientX - box.left, e.clientY - box.top);
    app.highlight(spot ? spot.index : -1);
    tooltip.hidden = !spot;
    if (!spot) return;
    const c = spot.candidate;
    tooltip.textContent = `${kindOf(c.kind).label}: score ${figure(c.score, 2)}, ` +
      `path cost ${c.path_cost < 0 ? "not planned" : figure(c.path_cost, 1)}, ${c.size} voxels`;
    tooltip.style.left = `${Math.min(spot.x + 14, box.width - 260)}px`;
    tooltip.style.top = `${spot.y + 12}px`;
  });
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    app.hasOwnView = true;
    app.camera.zoom(Math.exp(0.0012 * e.deltaY));
    app.redraw();
  }, { passive: false });
}
