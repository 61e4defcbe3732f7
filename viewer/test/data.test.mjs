// SPDX-License-Identifier: MIT
// The page's data handling, without a browser.
import assert from "node:assert/strict";
import { test } from "node:test";

import { partingOf, runNames } from "../src/compare.js";
import {
  checkFigure, flightsAt, floorLevels, floorOf, forEachRunVoxel, graphAt, isChecked, logLines, openingOf,
  segments,
} from "../src/data.js";
import { addStep, replayOf } from "../src/live.js";
import { COVERED, VoxelHistory, blockFaces } from "../src/voxels.js";

// The same bytes as in tests/trace/voxel_codec_test.cpp.
const RUNS = [0x02, 0x01, 0x04, 0x02, 0x01, 0x00, 0x02, 0x03, 0x01, 0x0a];

test("flights hold until a record has others", () => {
  const steps = [{}, { flights: [{ id: 0 }] }, {}, { flights: [{ id: 0 }, { id: 1 }] }, {}];
  assert.deepEqual([0, 1, 2, 3, 4].map((i) => flightsAt(steps, i).length), [0, 1, 1, 2, 2]);
});

test("the graph holds until it changes, and older replays have none", () => {
  const replay = { graphs: [{ index: 2, graph: "a" }, { index: 5, graph: "b" }] };
  assert.deepEqual([0, 2, 4, 5, 9].map((i) => graphAt(replay, i)), [null, "a", "a", "b", "b"]);
  assert.equal(graphAt({}, 3), null);
});

const UNCHECKED = {
  is_active: true, passed: false, confidence: 0, mask_quality: 0, visibility: 0, view_angle_deg: 0,
  distance_m: 0, failed_check: "",
};

test("an approach whose frame was not checked is no verification", () => {
  assert.equal(isChecked(UNCHECKED), false);
  assert.equal(isChecked({ ...UNCHECKED, failed_check: "confidence" }), true);
  assert.equal(isChecked({ ...UNCHECKED, passed: true }), true);
  assert.equal(isChecked({ ...UNCHECKED, is_active: false, passed: true }), false);
});

test("a check without a detection has a distance and no other figure", () => {
  const missed = { ...UNCHECKED, failed_check: "not detected", distance_m: 1.25 };
  assert.equal(checkFigure(missed, "confidence", 2), "–");
  assert.equal(checkFigure(missed, "view_angle_deg", 0), "–");
  assert.equal(checkFigure(missed, "distance_m", 2), "1.25");
  assert.equal(checkFigure({ ...missed, failed_check: "confidence" }, "confidence", 2), "0.00");
});

test("runs decode to the voxels that the C++ side encoded", () => {
  const got = [];
  forEachRunVoxel(new Uint8Array(RUNS), 0, RUNS.length, (...voxel) => got.push(voxel));
  assert.deepEqual(got, [[1, -1, 2, 1], [1, -1, 3, 1], [1, 0, 0, 10]]);
});

const zigzag = (n) => (n >= 0 ? 2 * n : -2 * n - 1);

/// Runs of single voxels near the origin, one byte a number.
function encode(voxels) {
  const bytes = [];
  let last = [0, 0, 0];
  for (const [x, y, z, value] of voxels) {
    bytes.push(...[x, y, z].map((v, i) => zigzag(v - last[i])), 1, value);
    last = [x, y, z];
  }
  return bytes;
}

/// Pseudo-random changes on a few voxels, several steps, some values back to 0.
function makeHistory(steps) {
  let state = 12345;
  const next = (n) => (state = (state * 1103515245 + 12345) % 2147483648) % n;
  const bytes = [], ends = [], maps = [];
  const map = new Map();
  for (let s = 0; s < steps; ++s) {
    const changed = new Map();
    for (let i = 0; i < 30; ++i) {
      changed.set([next(20) - 10, next(4) - 18, next(6)].join(), next(3) * (1 + 8 * next(2)) % 16);
    }
    for (const [key, value] of changed) map.set(key, value);
    bytes.push(...encode([...changed].map(([key, value]) => [...key.split(",").map(Number), value])));
    ends.push(bytes.length);
    maps.push(new Map(map));
  }
  const packed = new Uint8Array(bytes);
  return { history: new VoxelHistory(packed, ends), maps, bytes: packed, byteEnds: ends };
}

test("any seek gives the map as it was after that step", () => {
  const { history, maps } = makeHistory(25);
  for (const step of [24, 0, 13, 12, 24, 3, 3, 20, -1, 7]) {
    history.seek(step);
    for (const key of maps[24].keys()) {
      const expected = step < 0 ? 0 : maps[step].get(key) || 0;
      assert.equal(history.get(...key.split(",").map(Number)), expected, `${key} at ${step}`);
    }
  }
});

test("seeking marks exactly enough blocks: faces equal those of a map built anew", () => {
  const { history } = makeHistory(25);
  const isShown = [false, true, false, false, false, true, true, true];
  const cache = new Map();
  for (const step of [24, 5, 17, 0, 24]) {
    history.seek(step);
    for (const block of history.dirty) cache.set(block, blockFaces(history, block, isShown));
    history.dirty.clear();
    for (const block of history.blocks.values()) {
      assert.deepEqual(cache.get(block), blockFaces(history, block, isShown));
    }
  }
});

test("steps that come one by one give the map that they give at once", () => {
  const { history, maps, bytes, byteEnds } = makeHistory(25);
  const later = new VoxelHistory();
  byteEnds.forEach((end, i) => {
    later.append([bytes.subarray(i ? byteEnds[i - 1] : 0, end)]);
    later.seek([i, 0, -1, Math.floor(i / 2)][i % 4]);  // the user looks elsewhere meanwhile
  });
  assert.equal(later.count, 25);
  for (const step of [24, 3, 12, 24]) {
    later.seek(step);
    for (const key of maps[24].keys()) {
      assert.equal(later.get(...key.split(",").map(Number)), maps[step].get(key) || 0);
    }
  }
  assert.deepEqual(later.bounds(), history.bounds());
});

test("a run that is watched makes the replay that its file would hold", () => {
  const base64 = (bytes) => Buffer.from(bytes).toString("base64");
  const replay = replayOf({ info: { goals: [] }, depth_max_m: 10, states: [], runs: base64(RUNS) });
  const event = (step) => ({ step, image: "i", depth: "", sight: null, maps: "", runs: base64([1]) });
  const first = addStep(replay, event({ step: 0, goal_index: 0, goal: "bed" }));
  assert.deepEqual(first.map((bytes) => [...bytes]), [RUNS, [1]]);  // the map before, then the step's
  const second = { ...event({ step: 1, goal_index: 1, goal: "sofa" }), graph: { rooms: [] } };
  assert.equal(addStep(replay, second).length, 1);
  assert.deepEqual(replay.graphs, [{ index: 1, graph: { rooms: [] } }]);
  assert.deepEqual(replay.info.goals, ["bed", "sofa"]);
  assert.deepEqual([replay.steps.length, replay.images, replay.sights], [2, ["i", "i"], [null, null]]);
});

test("a lone voxel has five faces, two neighbours share none", () => {
  const shown = [false, true, false, false, false, false, false, false];
  const count = (voxels) => {
    const bytes = encode(voxels);
    const history = new VoxelHistory(new Uint8Array(bytes), [bytes.length]);
    const faces = [...history.blocks.values()].flatMap(
      (block) => [...blockFaces(history, block, shown)]);
    return faces.filter((byte, i) => i % 8 === 6 && byte < COVERED).length;
  };
  assert.equal(count([[0, 0, 0, 1]]), 5);
  assert.equal(count([[15, 0, 0, 1], [16, 0, 0, 1]]), 8);  // over a block's border
  assert.equal(count([[0, 0, 0, 1], [0, 0, 1, 1]]), 9);    // the lower one's top is covered
  assert.equal(count([[0, 0, 0, 2]]), 0);
});

test("an upper face knows the air above it", () => {
  const bytes = encode([[0, 0, 0, 1], [0, 0, 1, 10]]);
  const history = new VoxelHistory(new Uint8Array(bytes), [bytes.length]);
  const [block] = history.blocks.values();
  const faces = blockFaces(history, block, [false, true, false, false, false, false, false, false]);
  const up = [...Array(5).keys()].find((i) => faces[8 * i + 6] === 4);
  assert.equal(faces[8 * up + 7], 1 | (10 << 4));
});

test("floors are the levels where time was spent", () => {
  const steps = [0, 0, 0, 0.1, 1.4, 2.8, 2.8, 2.75].map((level_m) => ({ level_m }));
  assert.deepEqual(floorLevels(steps), [0, 2.8]);
  assert.deepEqual(floorLevels([]), []);
  assert.deepEqual([-1, 0, 2.6, 2.75, 5].map((z) => floorOf([0, 2.8], z)), [0, 0, 0, 1, 1]);
  assert.equal(floorOf([], 3), 0);
});

test("segments and log follow the steps", () => {
  const step = (number, mode, events = []) => ({ step: number, mode, reason: mode + "!", events });
  const replay = {
    steps: [step(0, "a", ["goal activated: bed"]), step(1, "a"), step(2, "b", ["mode: b", "hit"])],
    stages: [{ goal: "bed", outcome: "success", success: true, last_step: 1 }],
  };
  assert.deepEqual(segments(replay.steps, (s) => s.mode),
    [{ from: 0, to: 1, key: "a" }, { from: 2, to: 2, key: "b" }]);
  assert.deepEqual(logLines(replay).map((line) => [line.index, line.kind, line.text]), [
    [0, "mode", "a!"], [0, "event", "goal activated: bed"], [1, "success", "bed: success"],
    [2, "mode", "b!"], [2, "event", "hit"]]);
});

test("the page opens where a goal failed, at the start where none did", () => {
  const bed = { goal_index: 1, goal: "bed", outcome: "out_of_time", success: false };
  const step = (goal_index, events = [], action = "move_forward") => ({ goal_index, events, action });
  const steps = [step(0, ["go_to: no progress"]), step(0), step(1, ["climb: unreachable"]),
    step(1, ["bump", "go_to: no progress"]), step(1, ["go_to: did not open"]), step(1)];
  const open = (list, ...stages) =>
    openingOf({ steps: list.map((s, i) => ({ ...s, step: i })), stages });
  const start = { index: 0, text: "" };
  assert.deepEqual(open(steps, { goal_index: 0, success: true }), start);
  assert.deepEqual(open(steps.slice(0, 2), bed), start);  // cut off before it
  assert.deepEqual(open(steps, { goal_index: 0, success: true }, bed),
    { index: 3, text: "Goal 2, bed: out of time. Opened at step 3, go to: no progress." });
  assert.match(open([step(1), step(1)], bed).text, /Opened at step 1, its last step/);
  assert.equal(open([...steps, step(1, [], "stop")], bed).index, 6);
});

/// A run of steps that go forward, changed from some index on.
function runOf(count, changes = {}) {
  const steps = Array.from({ length: count }, (_, i) => ({
    goal: "bed", mode: "basic_explore", activity: "go_to", reason: "r", action: "move_forward",
    agent: { p_world: [i / 4, 0, 0], yaw_rad: 0, pitch_rad: 0 },
    candidates: [{ kind: "live_poi", p_world: [9, 0, 0], is_target: true }], ...changes[i],
  }));
  return { info: { variant: "full", config_hash: "0123456789" }, steps };
}

test("runs part where they first decide, and where they first act, differently", () => {
  assert.deepEqual(partingOf(runOf(9), runOf(9)), { decision: -1, action: -1 });
  assert.deepEqual(partingOf(runOf(9), runOf(9, { 3: { reason: "other" }, 5: { action: "turn_left" } })),
    { decision: 3, action: 5 });
  const target = { candidates: [{ kind: "live_poi", p_world: [8, 0, 0], is_target: true }] };
  assert.deepEqual(partingOf(runOf(9), runOf(9, { 4: target })), { decision: 4, action: -1 });
  assert.deepEqual(partingOf(runOf(9), runOf(7)), { decision: 7, action: 7 });
});

test("runs of one variant are told apart by their settings", () => {
  const [a, b] = [runOf(1), runOf(1)];
  b.info.config_hash = "fedcba9876";
  assert.deepEqual(runNames([a, b]), ["full 01234567", "full fedcba98"]);
  b.info.variant = "planar";
  assert.deepEqual(runNames([a, b]), ["full", "planar"]);
});
