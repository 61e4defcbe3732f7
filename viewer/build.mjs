// SPDX-License-Identifier: MIT
// `make viewer`: writes dist/replay.html, which is kept in git for builds without npm.
import { mkdirSync, writeFileSync } from "node:fs";

import { BUNDLE, bundle } from "./bundle.mjs";

const html = await bundle();
mkdirSync(new URL(".", BUNDLE), { recursive: true });
writeFileSync(BUNDLE, html);
console.log(`dist/replay.html: ${Buffer.byteLength(html)} bytes`);
