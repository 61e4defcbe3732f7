// SPDX-License-Identifier: MIT
// The page in a browser without a screen, opened from the disk: it draws, it asks nobody, keys work.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { coloursOf, keep, launch, noBrowser, open, press, untilDrawn } from "./browser.mjs";
import { samplePath } from "./sample.mjs";

const skip = noBrowser || (!samplePath("sample.html") && "no sample");

let browser = null;
before(async () => { if (!skip) browser = await launch(); });
after(() => browser?.close());

async function show(name, hash = "", from = browser) {
  const shown = await open(from, "file://" + samplePath(name) + hash);
  await untilDrawn(shown.page);
  return shown;
}

const DATA = /(<script id="replay-data"[^>]*>)(.*?)(<\/script>)/s;
const OTHER = /(<script id="other-data"[^>]*>)(.*?)(<\/script>)/s;

/// Writes the sample with its data changed, and perhaps a second run beside it, as `name`.
function derive(name, edit, editOther) {
  const html = readFileSync(samplePath("sample.html"), "utf8");
  const data = html.match(DATA)[2];
  const text = (change) => {
    const replay = JSON.parse(data);
    return JSON.stringify(change(replay) ?? replay).replace(/</g, "\\u003c");
  };
  let out = html.replace(DATA, (_, open, __, close) => open + text(edit) + close);
  if (editOther) out = out.replace(OTHER, (_, open, __, close) => open + text(editOther) + close);
  writeFileSync(samplePath("sample.html").replace("sample.html", name), out);
}

test("the page draws the map and asks nobody", { skip }, async () => {
  const { page, trouble } = await show("sample.html", "#step=70");
  assert.ok((await coloursOf(page)) > 50);
  assert.match(await page.textContent("#counter"), /^step 70 of \d+$/);
  assert.equal(await page.textContent("#mode"), "stair explore");
  assert.ok((await page.locator("#candidates tr").count()) >= 5);
  assert.ok(await page.locator("#camera-image").evaluate((image) => image.decode().then(() => image.naturalWidth)) > 0);
  await keep(page, "light");
  assert.deepEqual(trouble, []);
  await page.close();
});

test("the graph is listed as it was at the step", { skip }, async () => {
  const { page, trouble } = await show("sample.html", "#step=5");
  assert.ok(await page.locator("#graph-section").isHidden());
  await page.keyboard.press("End");
  assert.match(await page.textContent("#graph-count"), /2 rooms, 2 objects, 1 relations/);
  assert.match(await page.textContent("#graph"), /floor 2.*room 1.*plant 1 above bed 0/);  // counted as in all panels
  await keep(page, "graph");
  assert.deepEqual(trouble, []);
  await page.close();
});

/// Pixels of the layer over the camera image that are not clear.
function inkOf(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("camera-sight");
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let count = 0;
    for (let i = 3; i < pixels.length; i += 4) count += pixels[i] > 0;
    return count;
  });
}

test("what perception said lies over the camera image, part by part", { skip }, async () => {
  const html = readFileSync(samplePath("sample.html"), "utf8");
  const data = html.match(/<script id="replay-data"[^>]*>(.*?)<\/script>/s)[1];
  const step = JSON.parse(data).sights.findIndex((sight) => sight.boxes.length > 0);
  const { page, trouble } = await show("sample.html", `#step=${step}`);
  await page.waitForFunction((i) => document.body.dataset.sight === String(i), step, { timeout: 60000 });
  assert.deepEqual(await page.locator("#sights label").allTextContents(),
    ["boxes", "masks", "stairs", "similarity"]);
  const all = await inkOf(page);
  assert.ok(all > 0);
  await keep(page, "sight");
  await page.locator("#sights input").nth(3).check();
  await page.waitForTimeout(500);
  assert.ok((await inkOf(page)) > all, "similarity covers more than boxes and masks");
  assert.match(await page.textContent("#sights output"), /^0\.20 to 0\.90$/);
  await keep(page, "similarity");
  for (let i = 0; i < 4; ++i) await page.locator("#sights input").nth(i).uncheck();
  await page.waitForTimeout(500);
  assert.equal(await inkOf(page), 0);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("keys, buttons and the time line move through the steps", { skip }, async () => {
  const { page, trouble } = await show("sample.html", "#step=0");
  await press(page, "ArrowRight", 1);
  await press(page, "Shift+ArrowRight", 11);
  await press(page, "ArrowLeft", 10);
  const last = await page.evaluate(() => JSON.parse(
    document.getElementById("replay-data").textContent).steps.length - 1);
  await press(page, "End", last);
  assert.equal(await page.locator("#goals .bad").count(), 1);
  assert.equal(await page.locator("#goals .good").count(), 2);
  assert.match(await page.textContent("#verification-state"), /passed/);
  await press(page, "Home", 0);
  await page.keyboard.press("]");
  assert.match(await page.textContent("#facts"), /bed/);
  await page.locator("#log li").last().click();
  assert.match(await page.textContent("#counter"), new RegExp(`^step ${last} `));
  const box = await page.locator("#timeline").boundingBox();
  await page.mouse.click(box.x + 2, box.y + 20);
  assert.match(await page.textContent("#counter"), /^step 0 /);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("a replay with a goal that failed opens there and names it", { skip }, async () => {
  const { page, trouble } = await show("sample.html");
  assert.match(await page.textContent("#counter"), /^step (\d+) of \1$/);  // a wrong stop: the last step
  assert.match(await page.textContent("#notice"), /Goal 3, plant: .*its last step/);
  assert.match(await page.textContent("#facts"), /Activityapproach/);
  await keep(page, "failed");
  assert.deepEqual(trouble, []);
  await page.close();
});

test("steps of an approach that checked no frame show no figures", { skip }, async () => {
  derive("unchecked.html", (replay) => {
    const unchecked = { passed: false, confidence: 0, mask_quality: 0, visibility: 0, view_angle_deg: 0,
      distance_m: 0, failed_check: "" };
    for (const [i, step] of replay.steps.entries()) {
      if (!step.verification.is_active) Object.assign(step.verification, unchecked, { is_active: i > 0 });
    }
  });
  const { page, trouble } = await show("unchecked.html", "#step=1");
  assert.equal(await page.textContent("#verification-state"), "not yet for this goal");
  assert.equal(await page.locator("#verification .check").count(), 0);
  await press(page, "End", await page.evaluate(() => JSON.parse(
    document.getElementById("replay-data").textContent).steps.length - 1));
  assert.match(await page.textContent("#verification-state"), /passed/);
  assert.equal(await page.locator("#verification .check").count(), 5);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("playing moves on and stops at the end", { skip }, async () => {
  const { page, trouble } = await show("sample.html", "#step=125");
  await page.selectOption("#speed", "25");
  await page.click("#play");
  await page.waitForFunction(() => /Play/.test(document.getElementById("play").textContent), null,
    { timeout: 60000 });
  assert.match(await page.textContent("#counter"), /^step (\d+) of \1$/);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("floors, spread, layers and the dark theme draw", { skip }, async () => {
  const { page, trouble } = await show("sample.html", "#step=130&theme=dark&spread=3&floors=all");
  const all = await coloursOf(page);
  await keep(page, "dark");
  for (const key of ["1", "t", "f", "0"]) await page.keyboard.press(key);
  for (const row of await page.locator("#legend input").all()) await row.click();
  await page.waitForTimeout(500);
  assert.notEqual(await coloursOf(page), all);
  await keep(page, "layers");
  assert.deepEqual(trouble, []);
  await page.close();
});

test("a torn replay says so and shows what there is", { skip }, async () => {
  const { page, trouble } = await show("torn.html");
  assert.match(await page.textContent("#notice"), /cut off/);
  assert.ok((await coloursOf(page)) > 50);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("without WebGL the rest still works", { skip }, async () => {
  const plain = await launch({ hasGl: false });
  try {
    const { page, trouble } = await show("sample.html", "#step=70", plain);
    assert.match(await page.textContent("#view-message"), /cannot be drawn/);
    await press(page, "ArrowRight", 71);
    await keep(page, "no-webgl");
    assert.deepEqual(trouble.filter((text) => !/WebGL/.test(text)), []);
  } finally {
    await plain.close();
  }
});

test("two runs of an episode are compared where they part", { skip }, async () => {
  derive("compare.html", () => {}, (replay) => {
    replay.info.variant = "planar";
    replay.steps.slice(60).forEach((step, i) => {
      step.action = "turn_left";
      step.reason = "another way";
      step.agent.p_world[1] -= 0.02 * i;
    });
    replay.steps.length = 100;
    replay.voxels.ends.length = 100;
  });
  const { page, trouble } = await show("compare.html");
  assert.match(await page.textContent("#counter"), /^step 60 of/);
  assert.match(await page.textContent("#parting"), /decide differently from step 60 and act differently from step 60/);
  assert.match(await page.textContent("#other-now"), /^B planar here: .*turn left \(another way\)/);
  await press(page, "Shift+ArrowRight", 70);
  await keep(page, "compare-a");
  await page.click("#run-1");
  await page.waitForFunction(() => document.getElementById("run-1").classList.contains("on"));
  await press(page, "ArrowRight", 71);
  assert.match(await page.textContent("#reason"), /another way/);
  assert.match(await page.textContent("#episode"), /planar/);
  assert.ok((await coloursOf(page)) > 50);
  await keep(page, "compare-b");
  await press(page, "End", 99);
  await page.click("#run-0");
  await page.keyboard.press("ArrowLeft");
  await press(page, "End", 0 + (await page.evaluate(() => JSON.parse(
    document.getElementById("replay-data").textContent).steps.length - 1)));
  assert.match(await page.textContent("#other-now"), /^B planar has ended/);
  await press(page, "Home", 0);
  assert.match(await page.textContent("#other-now"), /does the same here/);
  assert.deepEqual(trouble, []);
  await page.close();
});

test("one run shows nothing of a comparison", { skip }, async () => {
  const { page } = await show("sample.html", "#step=3");
  assert.equal(await page.locator("#compare").isVisible(), false);
  assert.equal(await page.locator("#legend-layers input").count(), 8);  // all but the other run
  await page.close();
});

test("a damaged page says so", { skip }, async () => {
  const html = readFileSync(samplePath("sample.html"), "utf8");
  const at = html.search(DATA) + 5000;
  writeFileSync(samplePath("sample.html").replace("sample.html", "damaged.html"),
    html.slice(0, at) + html.slice(at + 40));
  const page = await browser.newPage();
  const trouble = [];
  page.on("pageerror", (error) => trouble.push(error.message));
  await page.goto("file://" + samplePath("damaged.html"));
  await page.waitForFunction(() => !document.getElementById("notice").hidden);
  assert.match(await page.textContent("#notice"), /damaged/);
  await keep(page, "damaged");
  assert.deepEqual(trouble, []);
  await page.close();
});

test("1,200 steps on two floors load, with few draw calls", { skip }, async () => {
  derive("long.html", (replay) => {
    const count = replay.steps.length, steps = 1200;
    const again = (list) => Array.from({ length: steps }, (_, i) => list[i % count]);
    for (const key of ["images", "depths", "sights", "maps"]) replay[key] = again(replay[key]);
    replay.steps = Array.from({ length: steps }, (_, i) => ({ ...replay.steps[i % count], step: i }));
    const ends = replay.voxels.ends;
    replay.voxels.ends = Array.from({ length: steps }, (_, i) => ends[Math.min(i, count - 1)]);
  });
  const started = performance.now();
  const { page, trouble } = await show("long.html", "#step=1199&floors=all");
  const seconds = (performance.now() - started) / 1000;
  const calls = Number(await page.evaluate(() => document.body.dataset.calls));
  console.log(`1,200 steps: ${seconds.toFixed(1)} s, ${calls} draw calls`);
  assert.ok(calls > 3 && calls <= 6, `${calls} draw calls`);  // whatever the size of the map
  await keep(page, "long");
  assert.deepEqual(trouble, []);
  await page.close();
});
