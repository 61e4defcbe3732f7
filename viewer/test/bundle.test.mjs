// SPDX-License-Identifier: MIT
// The bundle in git against its sources, and the parts of the page that stand on three.js.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { optional } from "./sample.mjs";

const made = await optional("../bundle.mjs"), three = await optional("three");
const skip = !three && "three is not installed; run scripts/setup.sh viewer";

test("the page in git is what its sources give, and is small", {
  skip: !made && "esbuild is not installed; run scripts/setup.sh viewer",
}, async () => {
  const kept = readFileSync(made.BUNDLE, "utf8");
  assert.ok(Buffer.byteLength(kept) <= made.MAX_BYTES);
  assert.ok(kept === await made.bundle(), "viewer/dist/replay.html is old: run `make viewer`");
});

test("the page names nobody to load from", { skip: !made && "no bundle" }, () => {
  const kept = readFileSync(made.BUNDLE, "utf8");
  assert.doesNotMatch(kept, /<(script|link|img|iframe)[^>]*\b(src|href)=/i);
  assert.match(kept, /three\.js authors/);
});

test("the camera holds the box that it frames and puts its middle in the middle", { skip }, async () => {
  const { OrbitCamera, projectPoint } = await import("../src/camera.js");
  const camera = new OrbitCamera();
  for (const [aspect, shift, pitch] of [[1.6, 0, 0.9], [0.6, 0, 0.4], [1.6, 0.25, 1.5707]]) {
    Object.assign(camera, { aspect, shift, pitch });
    camera.frame([-4, 2, 0], [6, 9, 5]);
    const matrix = camera.matrix();
    const middle = projectPoint(matrix, [1, 5.5, 2.5], 200, 100);
    assert.ok(Math.abs(middle[0] - 100 * (1 + shift)) < 0.01 && Math.abs(middle[1] - 50) < 0.01);
    let widest = 0;
    for (let i = 0; i < 8; ++i) {
      const corner = [i & 1 ? 6 : -4, i & 2 ? 9 : 2, i & 4 ? 5 : 0];
      const [x, y] = projectPoint(matrix, corner, 2, 2);
      assert.ok(x > 2 * shift && x < 2 && y > 0 && y < 2, `${corner} at ${x}, ${y}`);
      widest = Math.max(widest, Math.abs(y - 1), Math.abs(x - 1 - shift) / (1 - shift));
    }
    assert.ok(widest > 0.8);
  }
  assert.equal(projectPoint(camera.matrix(), camera.eye().map((v, i) => v + (i === 2 ? 9 : 0)), 2, 2),
    null);
});

test("a block that grows moves, and nothing of its old place is drawn", { skip }, async () => {
  const { FacePool } = await import("../src/face_pool.js");
  const pool = new FacePool();
  const bytesOf = (count, value) => new Uint8Array(new BigUint64Array(count).fill(value).buffer);
  const drawn = () => [...pool.faces.subarray(0, 4 * pool.end)].filter((face) => face !== 0n);
  const [a, b] = [{}, {}];
  pool.set(a, bytesOf(10, 1n));
  pool.set(b, bytesOf(20, 2n));
  pool.set(a, bytesOf(100, 3n));
  assert.equal(drawn().length, 4 * 120);
  assert.ok(!drawn().includes(1n));
  pool.set(a, bytesOf(5, 4n));
  assert.equal(drawn().length, 4 * 25);
  const { end } = pool;
  pool.set({}, bytesOf(16, 5n));  // where `a` was first
  assert.equal(pool.end, end);
  pool.set({}, bytesOf(20000, 6n));
  assert.equal(drawn().length, 4 * (25 + 16 + 20000));
  assert.equal(pool.geometry.drawRange.count, 6 * pool.end);
  assert.ok(pool.geometry.index.count >= 6 * pool.end);
  assert.equal(pool.attribute.updateRanges.length, 1);  // several would be slow to upload
});
