// SPDX-License-Identifier: MIT
// The legend: visible voxels and layers.
import { words } from "./data.js";
import { byId, make } from "./panels.js";
import {
  FLIGHT_COLOUR, KINDS, OBJECT_COLOUR, OTHER_RUN_COLOUR, PATH_COLOUR, RELATION_COLOUR, ROOM_COLOUR,
} from "./scene.js";

export const WALKABLE = "#b9dcc0", INFLATED = "#dccfb8";
const LAYERS = [
  ["trajectory", "trajectory, by goal", "#1c7ed6"],
  ["path", "planned path", PATH_COLOUR],
  ["flights", "flights of stairs", FLIGHT_COLOUR],
  ["rooms", "rooms of the map", ROOM_COLOUR],
  ["objects", "objects with a record", OBJECT_COLOUR],
  ["relations", "relations of objects", RELATION_COLOUR],
  ["candidates", "candidates and target", "#e64980"],
  ["goals", "true goals (agent unaware)", "#2f9e44"],
  ["other", "where the other run went", OTHER_RUN_COLOUR],
];

/// A checkbox with a colour and a name.
function legendRow(colour, name, isOn, onChange) {
  const box = make("input");
  box.type = "checkbox";
  box.checked = isOn;
  box.addEventListener("change", () => onChange(box.checked));
  const patch = make("i", "patch");
  patch.style.background = colour;
  return make("label", "", [box, patch, make("span", "", name)]);
}

export function fillLegend(app) {
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
    legendRow(colour, name, view.layers[key], (isOn) => {
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
