// SPDX-License-Identifier: MIT
// Where the sample that make_sample_replay wrote lies: $CROSSNAV_SAMPLE, set by ctest.
import { existsSync } from "node:fs";
import { join } from "node:path";

const folder = process.env.CROSSNAV_SAMPLE || "";

/// Path of a file of the sample, or null where there is no sample.
export function samplePath(name) {
  const path = join(folder, name);
  return folder && existsSync(path) ? path : null;
}

/// The module, or null where it is not installed (`npm ci` in viewer/ installs it).
export async function optional(name) {
  try {
    return await import(name);
  } catch {
    return null;
  }
}
