// SPDX-License-Identifier: MIT
// The faces of all blocks in one buffer, so that one draw call shows the map. Each block has a slot
// of a power of two; a block that outgrows its slot moves to a larger one.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from "three";

const CORNERS = [0, 1, 2, 2, 1, 3];
const SMALLEST_SLOT = 16;  // faces

export class FacePool {
  constructor() {
    this.geometry = new BufferGeometry();
    this.faces = new BigUint64Array(0);  // four times each face's eight bytes; 0 = no face
    this.grow(1 << 13);
    this.clear();
  }

  /// Removes every block.
  clear() {
    this.slots = new Map();
    this.free = new Map();  // capacity -> starts of slots
    this.end = 0;
    this.geometry.setDrawRange(0, 0);
  }

  /// `bytes`: output of blockFaces().
  set(block, bytes) {
    const faces = new BigUint64Array(bytes.buffer);
    const slot = this.slotFor(block, faces.length);
    if (!slot) return;
    for (let i = 0; i < faces.length; ++i) {
      const at = 4 * (slot.start + i);
      this.faces.fill(faces[i], at, at + 4);
    }
    this.faces.fill(0n, 4 * (slot.start + faces.length), 4 * (slot.start + slot.capacity));
    this.changed(slot);
  }

  slotFor(block, count) {
    let slot = this.slots.get(block);
    if (slot ? count <= slot.capacity : count === 0) return slot;
    if (slot) this.release(slot);
    slot = this.take(2 ** Math.ceil(Math.log2(Math.max(SMALLEST_SLOT, count))));
    this.slots.set(block, slot);
    return slot;
  }

  take(capacity) {
    const start = this.free.get(capacity)?.pop();
    if (start !== undefined) return { start, capacity };
    const slot = { start: this.end, capacity };
    this.end += capacity;
    if (4 * this.end > this.faces.length) this.grow(2 * this.end);
    this.geometry.setDrawRange(0, CORNERS.length * this.end);
    return slot;
  }

  release(slot) {
    this.faces.fill(0n, 4 * slot.start, 4 * (slot.start + slot.capacity));
    this.changed(slot);
    if (!this.free.has(slot.capacity)) this.free.set(slot.capacity, []);
    this.free.get(slot.capacity).push(slot.start);
  }

  /// Changed slots are uploaded in one range: a driver may copy the whole buffer for each range.
  changed({ start, capacity }) {
    const [range] = this.attribute.updateRanges;
    const first = 16 * start, behind = first + 16 * capacity;  // int16
    const from = range ? Math.min(range.start, first) : first;
    const to = range ? Math.max(range.start + range.count, behind) : behind;
    this.attribute.clearUpdateRanges();
    this.attribute.addUpdateRange(from, to - from);
    this.attribute.needsUpdate = true;
  }

  grow(capacity) {
    const faces = new BigUint64Array(4 * capacity), index = new Uint32Array(6 * capacity);
    faces.set(this.faces);
    for (let i = 0; i < capacity; ++i) {
      for (let k = 0; k < 6; ++k) index[6 * i + k] = 4 * i + CORNERS[k];
    }
    this.faces = faces;
    this.geometry.dispose();
    this.attribute = new BufferAttribute(new Int16Array(faces.buffer), 4);
    this.attribute.setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("a_face", this.attribute);
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }
}
