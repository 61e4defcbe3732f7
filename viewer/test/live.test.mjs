// SPDX-License-Identifier: MIT
// The page while a run goes on, from a real server: it follows, goes back, catches up, and outlives
// the run.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";

import { coloursOf, keep, launch, noBrowser, open, press, untilDrawn } from "./browser.mjs";

const program = process.env.CROSSNAV_WATCH_SAMPLE || "";
const skip = noBrowser || (!existsSync(program) && "$CROSSNAV_WATCH_SAMPLE names no program");

let browser = null;
before(async () => { if (!skip) browser = await launch(); });
after(() => browser?.close());

/// A run that goes on by so many steps when it is told to.
class Run {
  static async start(port = 0) {
    const run = new Run();
    run.child = spawn(program, [String(port)], { stdio: ["pipe", "pipe", "inherit"] });
    run.lines = createInterface({ input: run.child.stdout })[Symbol.asyncIterator]();
    run.address = (await run.lines.next()).value;
    return run;
  }

  async tell(text) {
    this.child.stdin.write(`${text}\n`);
    return (await this.lines.next()).value;
  }

  async end(signal) {
    const gone = new Promise((resolve) => this.child.once("exit", resolve));
    if (signal) this.child.kill(signal);
    else this.child.stdin.write("end\n");
    return gone;
  }
}

async function watch(run) {
  const shown = await open(browser, run.address, run.address);
  return shown;
}

async function untilCounter(page, text) {
  await page.waitForFunction(
    (wanted) => document.getElementById("counter").textContent === wanted, text, { timeout: 60000 });
}

async function untilState(page, state) {
  await page.waitForFunction(
    (wanted) => document.getElementById("live").dataset.state === wanted, state, { timeout: 60000 });
}

test("the page waits, follows the run, can be taken back and brought on again", { skip }, async () => {
  const run = await Run.start();
  const { page, trouble } = await watch(run);
  assert.match(await page.textContent("#notice"), /Waiting for the first step/);
  await run.tell(1);
  await untilDrawn(page);
  await untilCounter(page, "step 0 of 0");
  assert.equal(await page.locator("#notice").isVisible(), false);
  await run.tell(69);
  await untilCounter(page, "step 69 of 69");
  assert.equal(await page.locator("#live.on").count(), 1);
  assert.equal(await page.textContent("#mode"), "stair explore");
  assert.equal(await page.locator("#goals .good").count(), 1);  // the first goal was found
  await keep(page, "live-following");

  await page.keyboard.press("Home");
  await untilCounter(page, "step 0 of 69");
  assert.equal(await page.locator("#live.on").count(), 0);
  await run.tell(10);
  await untilCounter(page, "step 0 of 79");  // the run goes on, the page stays
  await press(page, "ArrowRight", 1);
  assert.equal(await page.textContent("#mode"), "basic explore");
  await keep(page, "live-back");
  await page.click("#live");
  await untilCounter(page, "step 79 of 79");
  assert.ok((await coloursOf(page)) > 50);

  await run.tell(1000);
  const last = await run.tell(0) - 1;
  await untilCounter(page, `step ${last} of ${last}`);
  assert.equal(await page.locator("#floors button").count(), 4);  // the second floor was found
  assert.equal(await run.end(), 0);
  await untilState(page, "ended");
  assert.match(await page.textContent("#notice"), /has ended/);
  await press(page, "Home", 0);
  await press(page, "End", last);
  await keep(page, "live-ended");
  assert.deepEqual(trouble, []);
  await page.close();
});

test("a page that comes late shows what a page from the start shows", { skip }, async () => {
  const run = await Run.start();
  await run.tell(100);
  const { page, trouble } = await watch(run);
  await untilCounter(page, "step 99 of 99");
  const log = await page.locator("#log").textContent();
  const second = await watch(run);
  await untilCounter(second.page, "step 99 of 99");
  assert.equal(await second.page.locator("#log").textContent(), log);
  await run.tell(5);
  await untilCounter(page, "step 104 of 104");
  await second.page.close();
  await run.tell(5);  // the run goes on when a viewer closes
  await untilCounter(page, "step 109 of 109");
  await run.end();
  assert.deepEqual(trouble, []);
  await page.close();
});

test("another episode of the same server begins anew", { skip }, async () => {
  const run = await Run.start();
  const { page, trouble } = await watch(run);
  await run.tell(90);
  await untilCounter(page, "step 89 of 89");
  await run.tell("again");
  await run.tell(30);
  await untilCounter(page, "step 29 of 29");
  assert.equal(await page.locator("#goals .good").count(), 0);
  await page.waitForFunction(() => document.body.dataset.drawn === "29");
  assert.ok((await coloursOf(page)) > 50);
  await keep(page, "live-again");
  await run.end();
  assert.deepEqual(trouble, []);
  await page.close();
});

test("a run that is killed leaves the page usable; a new one on its port is followed", { skip }, async () => {
  const run = await Run.start();
  const { page } = await watch(run);
  await run.tell(40);
  await untilCounter(page, "step 39 of 39");
  await run.end("SIGKILL");
  await untilState(page, "lost");
  await press(page, "ArrowLeft", 38);
  const next = await Run.start(Number(new URL(run.address).port));
  await next.tell(20);
  await untilCounter(page, "step 19 of 19");
  await untilState(page, "live");
  await next.end();
  await page.close();
});
