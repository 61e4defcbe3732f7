// SPDX-License-Identifier: MIT
// The voxel map at any step: blocks of 16 x 16 x 16 values (state + 8 x inflated), moved back and
// forth through the recorded changes, and the visible faces of each block for drawing.
import { forEachRunVoxel } from "./data.js";

export const BLOCK = 16;
export const FACE_BYTES = 8;
// Faces looked at from below are never drawn: the camera stays above the horizon.
const FACE_DIRECTIONS = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]];
const UP = 4;
/// Added to the direction of an upper face with a shown voxel on it: drawn only where walls are cut.
export const COVERED = 8;

function blockName(bx, by, bz) {
  return (bx + 32768) * 4294967296 + (by + 32768) * 65536 + (bz + 32768);
}

export class VoxelHistory {
  /// `ends[i]`: end of step i's runs in `bytes`.
  constructor(bytes = new Uint8Array(0), ends = []) {
    this.blocks = new Map();
    this.dirty = new Set();
    this.ends = [];  // of each decoded step: number of changes after it
    this.pending = [];  // runs of the steps that are not decoded yet
    this.step = -1;
    this.lastBlock = null;
    this.changes = 0;
    this.lo = [32767, 32767, 32767];
    this.hi = [-32768, -32768, -32768];
    this.reserve(1024);
    let begin = 0;
    for (const end of ends) {
      this.append([bytes.subarray(begin, end)]);
      begin = end;
    }
    this.decodeTo(ends.length - 1);
  }

  get count() {
    return this.ends.length + this.pending.length;
  }

  /// The next step's changes, in runs. They are decoded when that step is shown.
  append(pieces) {
    this.pending.push(pieces);
  }

  decodeTo(step) {
    if (step < this.ends.length) return;
    this.moveTo(this.ends.length - 1);
    for (const pieces of this.pending.splice(0, step + 1 - this.ends.length)) {
      for (const bytes of pieces) {
        forEachRunVoxel(bytes, 0, bytes.length, (x, y, z, value) => this.note(x, y, z, value));
      }
      this.ends.push(this.changes);
    }
    this.step = this.ends.length - 1;
  }

  note(x, y, z, value) {
    if (this.changes === this.after.length) this.reserve(2 * this.changes);
    const n = this.changes++;
    this.keys[3 * n] = x;
    this.keys[3 * n + 1] = y;
    this.keys[3 * n + 2] = z;
    this.after[n] = value;
    this.before[n] = this.get(x, y, z);
    this.set(x, y, z, value);
    this.reach(0, x);
    this.reach(1, y);
    this.reach(2, z);
  }

  reach(axis, v) {
    if (v < this.lo[axis]) this.lo[axis] = v;
    if (v >= this.hi[axis]) this.hi[axis] = v + 1;
  }

  reserve(count) {
    const grown = (array, larger) => {
      if (array) larger.set(array);
      return larger;
    };
    this.keys = grown(this.keys, new Int16Array(3 * count));
    this.after = grown(this.after, new Uint8Array(count));
    this.before = grown(this.before, new Uint8Array(count));
  }

  blockAt(x, y, z, make) {
    const bx = x >> 4, by = y >> 4, bz = z >> 4;
    const last = this.lastBlock;
    if (last && last.bx === bx && last.by === by && last.bz === bz) return last;
    const name = blockName(bx, by, bz);
    let block = this.blocks.get(name);
    if (!block && make) {
      block = { bx, by, bz, values: new Uint8Array(BLOCK ** 3), faces: null };
      this.blocks.set(name, block);
    }
    if (block) this.lastBlock = block;
    return block;
  }

  get(x, y, z) {
    const block = this.blockAt(x, y, z, false);
    return block ? block.values[((x & 15) << 8) | ((y & 15) << 4) | (z & 15)] : 0;
  }

  set(x, y, z, value) {
    const block = this.blockAt(x, y, z, true);
    block.values[((x & 15) << 8) | ((y & 15) << 4) | (z & 15)] = value;
    this.dirty.add(block);
    // A voxel at a block's border also determines its neighbour's faces.
    for (const [dx, dy, dz] of [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1]]) {
      const stays = (x >> 4) === ((x + dx) >> 4) && (y >> 4) === ((y + dy) >> 4) &&
        (z >> 4) === ((z + dz) >> 4);
      if (stays) continue;
      const other = this.blocks.get(blockName((x + dx) >> 4, (y + dy) >> 4, (z + dz) >> 4));
      if (other) this.dirty.add(other);
    }
  }

  /// The map after step `step` (-1: empty).
  seek(step) {
    this.decodeTo(step);
    this.moveTo(step);
  }

  moveTo(step) {
    const k = this.keys;
    const endOf = (s) => (s < 0 ? 0 : this.ends[s]);
    for (let i = endOf(this.step); i < endOf(step); ++i) {
      this.set(k[3 * i], k[3 * i + 1], k[3 * i + 2], this.after[i]);
    }
    for (let i = endOf(this.step) - 1; i >= endOf(step); --i) {
      this.set(k[3 * i], k[3 * i + 1], k[3 * i + 2], this.before[i]);
    }
    this.step = step;
  }

  /// Lowest and highest corner of all observed voxels, or null.
  bounds() {
    return this.changes ? { lo: this.lo, hi: this.hi } : null;
  }

  markAllDirty() {
    for (const block of this.blocks.values()) this.dirty.add(block);
  }
}

/// Faces of `block` between a shown and a hidden voxel. Eight bytes each: three int16 (the voxel),
/// direction, value: the voxel's state, and for upper faces 16 x the value of the air above.
export function blockFaces(history, block, isShown) {
  const out = [];
  const x0 = block.bx * BLOCK, y0 = block.by * BLOCK, z0 = block.bz * BLOCK;
  for (let i = 0; i < block.values.length; ++i) {
    const state = block.values[i] & 7;
    if (!isShown[state]) continue;
    const x = x0 + (i >> 8), y = y0 + ((i >> 4) & 15), z = z0 + (i & 15);
    for (let d = 0; d < FACE_DIRECTIONS.length; ++d) {
      const [dx, dy, dz] = FACE_DIRECTIONS[d];
      const next = history.get(x + dx, y + dy, z + dz);
      const isCovered = isShown[next & 7];
      if (isCovered && d !== UP) continue;
      out.push(x, y, z, isCovered ? d + COVERED : d, state | (d === UP ? next << 4 : 0));
    }
  }
  const faces = new DataView(new ArrayBuffer((out.length / 5) * FACE_BYTES));
  for (let i = 0, at = 0; i < out.length; i += 5, at += FACE_BYTES) {
    for (let axis = 0; axis < 3; ++axis) faces.setInt16(at + 2 * axis, out[i + axis], true);
    faces.setUint8(at + 6, out[i + 3]);
    faces.setUint8(at + 7, out[i + 4]);
  }
  return new Uint8Array(faces.buffer);
}
