// SPDX-License-Identifier: MIT
// Puts the page together: reads the embedded data, or follows a run, and listens to keys and pointer.
import { ReplayApp, fillHead } from "./app.js";
import { connectKeys, connectPointer, connectTools } from "./controls.js";
import { openingOf } from "./data.js";
import { fillLegend } from "./legend.js";
import { watchLive } from "./live.js";
import { byId, showNotice } from "./panels.js";
import { VoxelHistory } from "./voxels.js";

/// "#step=120&floors=2&top": a linkable view.
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

/// The replay in an element of the page, or null if it is missing or unreadable.
function embedded(id) {
  try {
    return JSON.parse(byId(id).textContent);
  } catch (error) {
    showNotice(`The page is damaged, its replay cannot be read (${error.message}). Export it again.`);
    return null;
  }
}

function connect(app) {
  app.showWhole();
  connectTools(app);
  connectKeys(app);
  connectPointer(app);
  fillLegend(app);
  new ResizeObserver(() => app.redraw()).observe(byId("view"));
  applyHash(app);
}

function startLive(replay) {
  const app = new ReplayApp([replay]);
  app.voxels = new VoxelHistory();
  connect(app);
  return app;
}

async function start() {
  const runs = [embedded("replay-data"), embedded("other-data")].filter((replay) => replay);
  if (runs.length === 0) return;
  if (runs[0].live) {
    watchLive(runs[0].live, startLive);
    return;
  }
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
  connect(app);
}

if (typeof document !== "undefined") start();
