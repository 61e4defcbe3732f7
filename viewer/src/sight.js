// SPDX-License-Identifier: MIT
// Perception of the frame, over the camera image.
import { figure } from "./data.js";
import { byId, make } from "./panels.js";

/// [key, name, colour].
const SIGHTS = [
  ["boxes", "boxes", "#f03e3e"],
  ["masks", "masks", "#f76707"],
  ["stairs", "stairs", "#1098ad"],
  ["similarity", "similarity", "#ae3ec9"],
];

/// Boxes, masks, stairs and similarity, drawn over the camera image if selected.
export class SightLayer {
  constructor(replay) {
    byId("sights").hidden = !replay.maps?.some((png) => png);
    this.replay = replay;
    this.canvas = byId("camera-sight");
    this.isOn = { boxes: true, masks: true, stairs: true, similarity: false };
    this.token = 0;
    this.index = 0;
    byId("sights").replaceChildren(...SIGHTS.map(([key, name, colour]) => {
      const box = make("input");
      box.type = "checkbox";
      box.checked = this.isOn[key];
      box.addEventListener("change", () => {
        this.isOn[key] = box.checked;
        this.show(this.index);
      });
      const patch = make("i", "patch");
      patch.style.background = colour;
      return make("label", "", [box, patch, name]);
    }), make("output"));
    this.readout = byId("sights").lastChild;
  }

  show(index) {
    this.index = index;
    const png = this.replay.maps?.[index], sight = this.replay.sights?.[index];
    if (png) byId("sights").hidden = false;
    this.canvas.hidden = !png || !sight;
    const hasRange = sight && sight.similarity_max > sight.similarity_min;
    this.readout.textContent = hasRange
      ? `${figure(sight.similarity_min, 2)} to ${figure(sight.similarity_max, 2)}` : "";
    const token = ++this.token;
    if (this.canvas.hidden) return;
    const image = new Image();
    image.onload = () => { if (token === this.token) this.paint(image, sight); };
    image.src = "data:image/png;base64," + png;
  }

  /// Red = masks, green = stairs, blue = similarity (docs/formats/replay.md).
  paint(image, sight) {
    const { width, height } = image, scale = 4;
    const maps = document.createElement("canvas");
    [maps.width, maps.height] = [width, height];
    const m = maps.getContext("2d", { willReadFrequently: true });
    m.drawImage(image, 0, 0);
    const pixels = m.getImageData(0, 0, width, height);
    for (let i = 0; i < pixels.data.length; i += 4) {
      pixels.data.set(this.tint(...pixels.data.subarray(i, i + 3)), i);
    }
    m.putImageData(pixels, 0, 0);
    [this.canvas.width, this.canvas.height] = [width * scale, height * scale];
    const c = this.canvas.getContext("2d");
    c.imageSmoothingEnabled = false;
    c.drawImage(maps, 0, 0, width * scale, height * scale);
    if (this.isOn.boxes) {
      const x = (width * scale) / sight.width_px, y = (height * scale) / sight.height_px;
      for (const box of sight.boxes) this.drawBox(c, box, x, y);
    }
    document.body.dataset.sight = String(this.index);
  }

  /// Colour and opacity of a pixel: a mask over stairs over similarity.
  tint(mask, stairs, similarity) {
    const of = (key) => hexToRgb(SIGHTS.find(([k]) => k === key)[2]);
    if (this.isOn.masks && mask > 127) return [...of("masks"), 130];
    if (this.isOn.stairs && stairs > 63) return [...of("stairs"), 0.6 * stairs];
    if (this.isOn.similarity) return [...of("similarity"), 0.75 * similarity];
    return [0, 0, 0, 0];
  }

  drawBox(c, box, x, y) {
    c.lineWidth = 3;
    c.strokeStyle = SIGHTS[0][2];
    c.strokeRect(box.u0 * x, box.v0 * y, (box.u1 - box.u0) * x, (box.v1 - box.v0) * y);
    c.font = "bold 20px sans-serif";
    const text = figure(box.confidence, 2), top = Math.max(22, box.v0 * y);
    c.fillStyle = SIGHTS[0][2];
    c.fillRect(box.u0 * x, top - 22, c.measureText(text).width + 8, 22);
    c.fillStyle = "#fff";
    c.fillText(text, box.u0 * x + 4, top - 5);
  }
}

function hexToRgb(hex) {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
}
