// SPDX-License-Identifier: MIT
// The replay page as one HTML file: src/ and three.js, joined by esbuild. The same packages give the
// same bytes.
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

/// Path of the page that the C++ build embeds.
export const BUNDLE = new URL("dist/replay.html", import.meta.url);
export const MAX_BYTES = 2e6;

function source(name) {
  return fileURLToPath(new URL(`src/${name}`, import.meta.url));
}

async function joined(name, options) {
  const result = await build({
    entryPoints: [source(name)], absWorkingDir: fileURLToPath(new URL(".", import.meta.url)),
    bundle: true, minify: true, write: false, charset: "utf8", target: "es2022",
    legalComments: "eof", logLevel: "error", ...options,
  });
  return result.outputFiles[0].text.trim();
}

/// The page's HTML, with marks for the data.
export async function bundle() {
  const parts = {
    STYLE: await joined("style.css", {}),
    SCRIPT: await joined("main.js", { format: "iife" }),
  };
  parts.LICENCE = readFileSync(new URL("node_modules/three/LICENSE", import.meta.url), "utf8").trim();
  const html = readFileSync(source("index.html"), "utf8")
    .replace(/\/\*(STYLE|SCRIPT|LICENCE)\*\//g, (_, name) => parts[name]);
  const size = Buffer.byteLength(html);
  if (size > MAX_BYTES) throw new Error(`the page has ${size} bytes, at most ${MAX_BYTES} are allowed`);
  return html;
}
