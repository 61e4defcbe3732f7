// SPDX-License-Identifier: MIT
// An orbit camera above a z-up world: where it looks, its matrix, and where a point lands on screen.

export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

const FIELD_OF_VIEW = 0.75;  // rad, vertical

export class OrbitCamera {
  constructor() {
    this.target = [0, 0, 0];
    this.yaw = -2.2;
    this.pitch = 0.95;
    this.distance = 14;
    this.aspect = 1;
    this.shift = 0;  // of the picture to the right, in half widths
  }

  /// Shows a box whole, as large as fits beside what covers the view at its left.
  frame(lo, hi) {
    this.target = lo.map((v, i) => (v + hi[i]) / 2);
    let near = 1, far = 400;
    for (let i = 0; i < 24; ++i) {
      this.distance = (near + far) / 2;
      if (this.holds(lo, hi)) far = this.distance;
      else near = this.distance;
    }
    this.distance = far;
  }

  holds(lo, hi) {
    const matrix = this.matrix();
    for (let i = 0; i < 8; ++i) {
      const corner = [i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]];
      const at = projectPoint(matrix, corner, 2, 2);
      if (!at || Math.abs(at[0] - 1 - this.shift) > 0.97 - this.shift) return false;
      if (Math.abs(at[1] - 1) > 0.95) return false;
    }
    return true;
  }

  axes() {
    const cp = Math.cos(this.pitch), sp = Math.sin(this.pitch);
    const cy = Math.cos(this.yaw), sy = Math.sin(this.yaw);
    const back = [cp * cy, cp * sy, sp];
    const right = [-sy, cy, 0];
    return { back, right, up: cross(back, right) };
  }

  eye() {
    const { back } = this.axes();
    return this.target.map((v, i) => v + this.distance * back[i]);
  }

  /// Clip from world, column-major.
  matrix() {
    const { back, right, up } = this.axes();
    const eye = this.eye();
    const near = Math.max(0.05, this.distance * 0.02), far = this.distance * 4 + 60;
    const f = 1 / Math.tan(FIELD_OF_VIEW / 2);
    const across = scaleRow(right, eye, f / this.aspect);
    const away = [-back[0], -back[1], -back[2], dot(back, eye)];
    const rows = [
      across.map((v, i) => v + this.shift * away[i]),
      scaleRow(up, eye, f),
      depthRow(back, eye, near, far),
      away,
    ];
    const m = new Float32Array(16);
    for (let row = 0; row < 4; ++row) {
      for (let column = 0; column < 4; ++column) m[4 * column + row] = rows[row][column];
    }
    return m;
  }

  orbit(dx, dy) {
    this.yaw -= 0.006 * dx;
    this.pitch = Math.min(1.5707, Math.max(0.08, this.pitch + 0.006 * dy));
  }

  pan(dx, dy, height_px) {
    const { right, up } = this.axes();
    const k = (2 * this.distance * Math.tan(FIELD_OF_VIEW / 2)) / height_px;
    this.target = this.target.map((v, i) => v - k * dx * right[i] + k * dy * up[i]);
  }

  zoom(factor) {
    this.distance = Math.min(400, Math.max(0.8, this.distance * factor));
  }
}

function scaleRow(axis, eye, scale) {
  return [axis[0] * scale, axis[1] * scale, axis[2] * scale, -dot(axis, eye) * scale];
}

function depthRow(back, eye, near, far) {
  const a = (far + near) / (near - far), b = (2 * far * near) / (near - far);
  return [a * back[0], a * back[1], a * back[2], -a * dot(back, eye) + b];
}

/// Pixel of a world point, or null behind the camera.
export function projectPoint(matrix, p, width, height) {
  const clip = [0, 1, 3].map(
    (row) => matrix[row] * p[0] + matrix[4 + row] * p[1] + matrix[8 + row] * p[2] + matrix[12 + row]);
  if (clip[2] <= 0.01) return null;
  return [(0.5 + 0.5 * clip[0] / clip[2]) * width, (0.5 - 0.5 * clip[1] / clip[2]) * height];
}
