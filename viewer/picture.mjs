// SPDX-License-Identifier: MIT
// node viewer/picture.mjs PAGE.html OUT.png ['#step=120&floors=all']: a picture of a replay page.
import { pathToFileURL } from "node:url";

import { launch, noBrowser, open, untilDrawn } from "./test/browser.mjs";

const [pagePath, picture, hash = ""] = process.argv.slice(2);
if (noBrowser || !picture) {
  console.error(noBrowser || "usage: node viewer/picture.mjs PAGE.html OUT.png ['#step=120']");
  process.exit(1);
}
const browser = await launch();
const { page } = await open(browser, pathToFileURL(pagePath).href + hash);
await page.setViewportSize({ width: 1400, height: 900 });
page.setDefaultTimeout(300000);  // software drawing on a busy machine
await untilDrawn(page);
await page.waitForFunction(() => document.getElementById("camera-image").complete, null,
  { timeout: 300000 });
await page.screenshot({ path: picture, timeout: 300000 });
await browser.close();
