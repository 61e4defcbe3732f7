// SPDX-License-Identifier: MIT
// Panels beside the 3D view: camera images, decisions of the agent and their reasons.
import { checkFigure, figure, floorOf, isChecked, logLines, words } from "./data.js";
import { GOAL_COLOURS, MODE_COLOURS, kindOf } from "./scene.js";

export function byId(id) {
  return document.getElementById(id);
}

/// Adds to the line below the head.
export function showNotice(text) {
  const notice = byId("notice");
  notice.textContent = notice.hidden ? text : `${notice.textContent} ${text}`;
  notice.hidden = false;
}

export function hideNotice() {
  byId("notice").hidden = true;
}

/// Scrolls `box` (which must be positioned) until `row` is visible.
function keepInView(row, box) {
  const top = row.offsetTop;
  if (top < box.scrollTop || top + row.offsetHeight > box.scrollTop + box.clientHeight) {
    box.scrollTop = top - box.clientHeight + row.offsetHeight + 4;
  }
}

/// Element with class, text or children.
export function make(tag, className, content) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (Array.isArray(content)) element.append(...content);
  else if (content !== undefined) element.textContent = content;
  return element;
}

export function badge(text, colour) {
  const element = make("span", "badge", text);
  element.style.background = colour;
  return element;
}

export function modeColour(mode) {
  return MODE_COLOURS[mode] || "#868e96";
}

// Near is bright, far is dark; 0 (invalid) has a separate colour.
const DEPTH_STOPS = [[253, 231, 155], [246, 151, 99], [201, 79, 121], [114, 47, 130], [33, 20, 70]];

function depthColour(share) {
  const at = Math.min(0.9999, Math.max(0, share)) * (DEPTH_STOPS.length - 1);
  const i = Math.floor(at), f = at - i;
  return DEPTH_STOPS[i].map((v, k) => v + f * (DEPTH_STOPS[i + 1][k] - v));
}

export class CameraPanel {
  constructor(replay) {
    this.replay = replay;
    this.image = byId("camera-image");
    this.canvas = byId("camera-depth");
    this.readout = byId("depth-readout");
    this.grey = null;
    this.token = 0;
    byId("depth-scale-max").textContent = `${replay.depth_max_m} m`;
    this.canvas.onmousemove = (e) => this.readDepth(e);
    this.canvas.onmouseleave = () => { this.readout.textContent = ""; };
  }

  show(index) {
    const jpeg = this.replay.images[index], png = this.replay.depths[index];
    this.image.hidden = !jpeg;
    byId("no-image").hidden = Boolean(jpeg);
    if (jpeg) this.image.src = "data:image/jpeg;base64," + jpeg;
    this.canvas.hidden = !png;
    byId("no-depth").hidden = Boolean(png);
    const token = ++this.token;
    if (!png) return;
    const image = new Image();
    image.onload = () => { if (token === this.token) this.paintDepth(image); };
    image.src = "data:image/png;base64," + png;
  }

  paintDepth(image) {
    const { width, height } = image;
    this.canvas.width = width;
    this.canvas.height = height;
    const c = this.canvas.getContext("2d", { willReadFrequently: true });
    c.drawImage(image, 0, 0);
    const pixels = c.getImageData(0, 0, width, height);
    this.grey = new Uint8Array(width * height);
    for (let i = 0; i < this.grey.length; ++i) {
      const grey = pixels.data[4 * i];
      this.grey[i] = grey;
      const rgb = grey === 0 ? [128, 128, 128] : depthColour((grey - 1) / 254);
      for (let k = 0; k < 3; ++k) pixels.data[4 * i + k] = rgb[k];
    }
    c.putImageData(pixels, 0, 0);
  }

  readDepth(event) {
    if (!this.grey) return;
    const box = this.canvas.getBoundingClientRect();
    const u = Math.floor(((event.clientX - box.left) / box.width) * this.canvas.width);
    const v = Math.floor(((event.clientY - box.top) / box.height) * this.canvas.height);
    const grey = this.grey[v * this.canvas.width + u];
    if (grey === undefined) return;
    const metres = ((grey - 1) / 254) * this.replay.depth_max_m;
    this.readout.textContent = grey === 0 ? "no depth" : `${metres.toFixed(2)} m`;
  }
}

export class StatusPanel {
  /// `view.levels`: heights of the known floors.
  constructor(replay, view) {
    this.replay = replay;
    this.view = view;
  }

  show(index) {
    const step = this.replay.steps[index];
    const mode = byId("mode");
    mode.textContent = words(step.mode) || "no mode";
    mode.style.background = modeColour(step.mode);
    byId("reason").textContent = step.reason || "no reason given";
    const z = step.agent.p_world[2], { levels } = this.view;
    const floor = levels.length > 1 ? `${floorOf(levels, z) + 1} of ${levels.length}` : "1";
    const degrees = (rad) => `${Math.round((rad * 180) / Math.PI)}°`;
    const facts = [
      ["Goal", words(step.goal)],
      ["Action", words(step.action)],
      ...(step.activity ? [["Activity", words(step.activity)]] : []),
      ["Floor", `${floor} (${figure(step.level_m, 2)} m)`],
      ["Position", step.agent.p_world.map((v) => figure(v, 2)).join(", ")],
      ["Heading", `${degrees(step.agent.yaw_rad)}, pitch ${degrees(step.agent.pitch_rad)}`],
      ["Detections", `${step.detections}${step.all_explored ? ", all explored" : ""}`],
    ];
    byId("facts").replaceChildren(...facts.flatMap(([k, v]) => [make("dt", "", k), make("dd", "", v)]));
  }
}

export class CandidatesPanel {
  constructor(replay, onHover) {
    this.replay = replay;
    this.onHover = onHover;
    this.body = byId("candidates");
  }

  show(index) {
    const candidates = this.replay.steps[index].candidates;
    byId("candidate-count").textContent = candidates.length ? String(candidates.length) : "none";
    this.body.replaceChildren(...candidates.map((c, i) => this.row(c, i)));
    const target = this.body.querySelector(".target");
    if (target) keepInView(target, this.body.closest(".scroll"));
  }

  row(candidate, i) {
    const kind = kindOf(candidate.kind);
    const mark = badge(kind.mark, kind.colour);
    const name = make("td", "kind", [mark, make("span", "", kind.label)]);
    const cost = candidate.path_cost < 0 ? "–" : figure(candidate.path_cost, 1);
    const row = make("tr", candidate.is_target ? "target" : candidate.is_reachable ? "" : "unreachable", [
      name,
      make("td", "number", figure(candidate.score, 2)),
      make("td", "number", cost),
      make("td", "number", String(candidate.size)),
      make("td", "", candidate.is_target ? "target" : candidate.is_reachable ? "" : "no path"),
    ]);
    row.addEventListener("mouseenter", () => this.onHover(i));
    row.addEventListener("mouseleave", () => this.onHover(-1));
    return row;
  }

  highlight(index) {
    [...this.body.children].forEach((row, i) => row.classList.toggle("hovered", i === index));
  }
}

/// Key, label, decimals, unit.
const CHECKS = [
  ["confidence", "Confidence", 2, ""],
  ["mask_quality", "Mask quality", 2, ""],
  ["visibility", "Visibility", 2, ""],
  ["view_angle_deg", "View angle", 0, "°"],
  ["distance_m", "Distance", 2, " m"],
];

export class VerificationPanel {
  constructor(replay) {
    this.replay = replay;
    // For each step the last checked step up to it, within the goal; -1 = none.
    this.lastChecked = [];
    this.grow();
  }

  /// Called after steps were added.
  grow() {
    const { steps } = this.replay;
    for (let i = this.lastChecked.length; i < steps.length; ++i) {
      const isSameGoal = i > 0 && steps[i - 1].goal_index === steps[i].goal_index;
      const before = isSameGoal ? this.lastChecked[i - 1] : -1;
      this.lastChecked.push(isChecked(steps[i].verification) ? i : before);
    }
  }

  show(index) {
    const at = this.lastChecked[index];
    const head = byId("verification-state"), list = byId("verification");
    if (at < 0) {
      head.textContent = "not yet for this goal";
      head.className = "muted";
      list.replaceChildren();
      return;
    }
    const v = this.replay.steps[at].verification;
    const when = at === index ? "now" : `step ${this.replay.steps[at].step}`;
    const result = v.passed ? "passed" : `failed: ${words(v.failed_check)}`;
    head.textContent = `${result} (${when})`;
    head.className = v.passed ? "good" : "bad";
    list.replaceChildren(...CHECKS.map(([key, label, decimals, unit]) => {
      const text = checkFigure(v, key, decimals);
      const isFailed = !v.passed && failsOf(v.failed_check, key);
      return make("div", "check" + (isFailed ? " bad" : v.passed ? " good" : ""),
        [make("b", "", text + (text === "–" ? "" : unit)), make("span", "", label)]);
    }));
  }
}

/// Whether the named check belongs to this figure.
function failsOf(failed, key) {
  const stem = key.replace(/_(deg|m)$/, "");
  return Boolean(failed) && (failed.includes(stem) || stem.includes(failed) ||
    (stem === "mask_quality" && failed.includes("mask")) ||
    (stem === "view_angle" && /angle|direction/.test(failed)));
}

export class LogPanel {
  constructor(replay, onSeek) {
    this.replay = replay;
    this.onSeek = onSeek;
    this.rows = [];
    this.index = 0;
    this.list = byId("log");
    this.list.replaceChildren();
    this.grow();
  }

  /// Called after steps were added: appends their lines.
  grow() {
    this.lines = logLines(this.replay);
    const fresh = this.lines.slice(this.rows.length).map((line) => this.row(line));
    this.rows.push(...fresh);
    this.list.append(...fresh);
    byId("log-count").textContent = String(this.lines.length);
  }

  row(line) {
    const content = line.kind === "mode" ? [badge(words(line.mode), modeColour(line.mode)),
      make("span", "", line.text)] : [make("span", line.kind, line.text)];
    const row = make("li", line.index > this.index ? "future" : "", [make("span", "when", String(this.replay.steps[line.index].step)),
      make("span", "what", content)]);
    row.addEventListener("click", () => this.onSeek(line.index));
    return row;
  }

  show(index) {
    this.index = index;
    let last = -1;
    this.lines.forEach((line, i) => {
      if (line.index <= index) last = i;
      this.rows[i].classList.toggle("future", line.index > index);
      this.rows[i].classList.toggle("now", line.index === index);
    });
    if (last < 0) return;
    keepInView(this.rows[last], this.list);
  }
}

/// Goals in the head line, with their known results.
export class GoalsHead {
  constructor(replay, onSeek) {
    this.replay = replay;
    this.onSeek = onSeek;
  }

  show(index) {
    const now = this.replay.steps[index];
    byId("goals").replaceChildren(...this.replay.info.goals.map((goal, i) => {
      const stage = this.replay.stages.find((s) => s.goal_index === i);
      const isOver = stage && stage.last_step <= now.step;
      const chip = make("button", "goal", [
        badge(String(i + 1), GOAL_COLOURS[i % GOAL_COLOURS.length]),
        make("span", "", words(goal)),
      ]);
      if (isOver) {
        chip.append(make("span", stage.success ? "good" : "bad",
          stage.success ? "✓ found" : "✗ " + words(stage.outcome)));
        chip.title = `${stage.outcome}: walked ${figure(stage.length_m, 1)} m, ` +
          `shortest ${figure(stage.shortest_m, 1)} m`;
      }
      chip.classList.toggle("current", i === now.goal_index);
      const first = this.replay.steps.findIndex((s) => s.goal_index === i);
      chip.disabled = first < 0;
      chip.addEventListener("click", () => this.onSeek(first));
      return chip;
    }));
  }
}
