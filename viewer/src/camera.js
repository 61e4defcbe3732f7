// SPDX-License-Identifier: MIT
// An orbit camera above a z-up world: target, matrix, and projection of points to the screen.
import { MathUtils, Matrix4, PerspectiveCamera, Vector3 } from "three";

const FIELD_OF_VIEW = 0.75;  // rad, vertical

export class OrbitCamera {
  constructor() {
    this.three = new PerspectiveCamera(MathUtils.radToDeg(FIELD_OF_VIEW));
    this.target = [0, 0, 0];
    this.yaw = -2.2;
    this.pitch = 0.95;
    this.distance = 14;
    this.aspect = 1;
    this.shift = 0;  // of the picture to the right, in half widths
  }

  /// Shows a whole box, as large as fits beside the panel at the left.
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
    const back = new Vector3(cp * cy, cp * sy, sp), right = new Vector3(-sy, cy, 0);
    return { back, right, up: new Vector3().crossVectors(back, right) };
  }

  eye() {
    const { back } = this.axes();
    return this.target.map((v, i) => v + this.distance * back.getComponent(i));
  }

  /// Copies the pose to three.js' camera.
  update() {
    const { back, right, up } = this.axes(), camera = this.three;
    camera.position.set(...this.eye());
    camera.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(right, up, back));
    camera.near = Math.max(0.05, this.distance * 0.02);
    camera.far = this.distance * 4 + 60;
    const width = 2 * this.aspect;
    camera.setViewOffset(width, 2, -this.shift * this.aspect, 0, width, 2);  // sets the aspect, too
    camera.updateMatrixWorld();
    return camera;
  }

  /// Clip from world, column-major.
  matrix() {
    const camera = this.update();
    return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
  }

  orbit(dx, dy) {
    this.yaw -= 0.006 * dx;
    this.pitch = Math.min(1.5707, Math.max(0.08, this.pitch + 0.006 * dy));
  }

  pan(dx, dy, height_px) {
    const { right, up } = this.axes();
    const k = (2 * this.distance * Math.tan(FIELD_OF_VIEW / 2)) / height_px;
    this.target = this.target.map(
      (v, i) => v - k * dx * right.getComponent(i) + k * dy * up.getComponent(i));
  }

  zoom(factor) {
    this.distance = Math.min(400, Math.max(0.8, this.distance * factor));
  }
}

/// Pixel of a world point, or null behind the camera.
export function projectPoint(matrix, p, width, height) {
  const clip = [0, 1, 3].map(
    (row) => matrix[row] * p[0] + matrix[4 + row] * p[1] + matrix[8 + row] * p[2] + matrix[12 + row]);
  if (clip[2] <= 0.01) return null;
  return [(0.5 + 0.5 * clip[0] / clip[2]) * width, (0.5 - 0.5 * clip[1] / clip[2]) * height];
}
