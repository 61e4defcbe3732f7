// SPDX-License-Identifier: MIT
// Chromium without a screen, drawing in software: times are generous. $CROSSNAV_SCREENSHOTS (a
// folder) keeps what was seen.
import { existsSync } from "node:fs";
import { join } from "node:path";

import { optional } from "./sample.mjs";

const playwright = await optional("playwright-core");
const program = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome"].find((path) => path && existsSync(path));
/// Why there is no browser; "" where there is one.
export const noBrowser = !playwright ? "playwright-core is not installed; run scripts/setup.sh viewer"
  : !program ? "there is no Chromium; run scripts/setup.sh viewer" : "";
const FLAGS = ["--no-sandbox", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--no-first-run", "--disable-quic"];
const SOFTWARE_GL = ["--disable-gpu", "--enable-unsafe-swiftshader", "--use-gl=angle",
  "--use-angle=swiftshader"];
const NO_GL = ["--disable-gpu", "--disable-3d-apis"];

export function launch({ hasGl = true } = {}) {
  return playwright.chromium.launch(
    { executablePath: program, args: [...FLAGS, ...(hasGl ? SOFTWARE_GL : NO_GL)] });
}

/// The page at `url` with everything that went wrong in it. `own`: start of addresses that it may
/// ask for.
export async function open(browser, url, own = "file:") {
  const page = await browser.newPage({ viewport: { width: 1280, height: 760 } });
  const trouble = [];
  page.on("pageerror", (error) => trouble.push(error.message));
  page.on("console", (line) => { if (line.type() === "error") trouble.push(line.text()); });
  page.on("request", (request) => {
    const asked = request.url();
    if (!asked.startsWith(own) && !/^(data|blob):/.test(asked)) trouble.push(`asked for ${asked}`);
  });
  await page.goto(url);
  return { page, trouble };
}

export async function untilDrawn(page) {
  await page.waitForFunction(() => document.body.dataset.drawn !== undefined, null,
    { timeout: 300000 });
}

export async function keep(page, name) {
  const folder = process.env.CROSSNAV_SCREENSHOTS;
  if (folder) await page.screenshot({ path: join(folder, name + ".png") });
}

/// How many different colours the 3D view shows.
export function coloursOf(page) {
  return page.evaluate(() => {
    const gl = document.getElementById("gl").getContext("webgl2");
    const { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
    const pixels = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const seen = new Set();
    for (let i = 0; i < pixels.length; i += 4) {
      seen.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]);
    }
    return seen.size;
  });
}

export async function press(page, key, drawn) {
  await page.keyboard.press(key);
  await page.waitForFunction((step) => document.body.dataset.drawn === step, String(drawn),
    { timeout: 60000 });
}
