// SPDX-License-Identifier: MIT
// Decodes the replay's data in the page to arrays.

export function bytesOfBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function zigzag(n) {
  return n % 2 === 0 ? n / 2 : -(n + 1) / 2;
}

/// Visits the voxels of one step's runs: visit(x, y, z, value), value = state + 8 x inflated.
export function forEachRunVoxel(bytes, begin, end, visit) {
  let at = begin;
  const varint = () => {
    let value = 0, scale = 1, byte;
    do {
      byte = bytes[at++];
      value += (byte & 127) * scale;
      scale *= 128;
    } while (byte >= 128 && at < end);
    return value;
  };
  let x = 0, y = 0, z = 0;
  while (at < end) {
    x += zigzag(varint());
    y += zigzag(varint());
    z += zigzag(varint());
    const length = varint(), value = varint();
    for (let i = 0; i < length; ++i) visit(x, y, z + i, value);
  }
}

/// Heights of the floors: exploration levels with the most steps, at least `gap_m` apart.
export function floorLevels(steps, gap_m = 1.8) {
  const counts = new Map();
  for (const step of steps) counts.set(step.level_m, (counts.get(step.level_m) || 0) + 1);
  const byCount = [...counts.keys()].sort((a, b) => counts.get(b) - counts.get(a) || a - b);
  const levels = [];
  for (const level of byCount) {
    if (levels.every((other) => Math.abs(other - level) >= gap_m)) levels.push(level);
  }
  return levels.sort((a, b) => a - b);
}

/// A floor's own surface is at most this far below its level; lower surfaces are ceilings.
export const FLOOR_MARGIN_M = 0.13;

/// Index of the floor at a height.
export function floorOf(levels, z) {
  let floor = 0;
  for (let i = 1; i < levels.length; ++i) {
    if (z > levels[i] - FLOOR_MARGIN_M) floor = i;
  }
  return floor;
}

/// Whether a step has the result of a verification. An approach is active before its first frame is
/// checked; its figures are zeros then.
export function isChecked(verification) {
  return verification.is_active && (verification.passed || verification.failed_check !== "");
}

/// A figure of a verification; a dash where no detection in the frame gave one.
export function checkFigure(verification, key, decimals) {
  const isMissing = verification.failed_check === "not detected" && key !== "distance_m";
  return figure(isMissing ? null : verification[key], decimals);
}

/// Known flights of stairs after a step: records hold them only after a change.
export function flightsAt(steps, index) {
  for (let i = index; i >= 0; --i) if (steps[i].flights) return steps[i].flights;
  return [];
}

/// The scene graph after a step, or null: replays hold it only where it changed.
export function graphAt(replay, index) {
  const graphs = replay.graphs || [];
  for (let i = graphs.length - 1; i >= 0; --i) if (graphs[i].index <= index) return graphs[i].graph;
  return null;
}

/// Consecutive steps for which key(step) is equal: [{from, to, key}], both ends included.
export function segments(steps, key) {
  const out = [];
  steps.forEach((step, i) => {
    const value = key(step);
    const last = out[out.length - 1];
    if (last && last.key === value) last.to = i;
    else out.push({ from: i, to: i, key: value });
  });
  return out;
}

/// Lines of the log: [{index, kind, text}].
export function logLines(replay) {
  const lines = [];
  let mode = null, reason = null;
  const stages = [...replay.stages];
  replay.steps.forEach((step, index) => {
    if (step.mode !== mode || step.reason !== reason) {
      lines.push({ index, kind: "mode", mode: step.mode, text: step.reason });
      mode = step.mode;
      reason = step.reason;
    }
    for (const text of step.events) {
      if (text !== `mode: ${step.mode}`) lines.push({ index, kind: "event", text });
    }
    while (stages.length && stages[0].last_step <= step.step) {
      const stage = stages.shift();
      const kind = stage.success ? "success" : "failure";
      lines.push({ index, kind, text: `${stage.goal}: ${stage.outcome}` });
    }
  });
  return lines;
}

const BAD_ENDING = /^(go_to|climb|visit|approach): (no progress|unreachable|refuted)$/;

/// Opening step, {index, text}: the start if nothing failed (text ""), else in the first failed
/// stage: its last activity with a bad ending, or its last step if there is none or the agent
/// stopped.
export function openingOf(replay) {
  const stage = replay.stages.find((s) => !s.success);
  let last = -1, bad = -1, why = "";
  replay.steps.forEach((step, index) => {
    if (step.goal_index !== stage?.goal_index) return;
    last = index;
    const ending = step.events.find((text) => BAD_ENDING.test(text));
    if (ending) [bad, why] = [index, ending];
  });
  if (last < 0) return { index: 0, text: "" };
  const isLast = bad < 0 || replay.steps[last].action === "stop", index = isLast ? last : bad;
  const head = `Goal ${stage.goal_index + 1}, ${words(stage.goal)}: ${words(stage.outcome)}.`;
  const where = isLast ? "its last step" : words(why);
  return { index, text: `${head} Opened at step ${replay.steps[index].step}, ${where}.` };
}

/// A figure with this many decimals; a dash for numbers that were not finite.
export function figure(value, decimals) {
  return value === null ? "–" : value.toFixed(decimals);
}

export function words(name) {
  return name.replace(/_/g, " ");
}
