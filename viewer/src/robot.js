// SPDX-License-Identifier: MIT
// The robot in the 3D view: a post with an arrow on top that shows the heading.
import {
  AmbientLight, CylinderGeometry, DirectionalLight, DoubleSide, Group, Mesh, MeshLambertMaterial,
  Shape, ShapeGeometry,
} from "three";

const HEIGHT_M = 0.88, RADIUS_M = 0.12, CLEARANCE_M = 0.05;

export class Robot {
  constructor() {
    const height = HEIGHT_M - CLEARANCE_M;
    const post = new Mesh(new CylinderGeometry(RADIUS_M, RADIUS_M, height, 16),
      new MeshLambertMaterial({ color: "#1f2933" }));
    post.rotation.x = Math.PI / 2;  // z is up
    post.position.z = CLEARANCE_M + height / 2;
    const arrow = new Mesh(new ShapeGeometry(arrowShape()),
      new MeshLambertMaterial({ color: "#ffd43b", side: DoubleSide }));
    arrow.position.z = HEIGHT_M + 0.02;
    const sun = new DirectionalLight("#ffffff", 0.28 * Math.PI);
    sun.position.set(0.4, 0.2, 0.9);
    this.group = new Group();
    this.group.add(post, arrow, sun, new AmbientLight("#ffffff", 0.72 * Math.PI));
  }

  /// {p_world, yaw_rad} of the foot, or null: not shown.
  place(robot) {
    this.group.visible = robot !== null;
    if (!robot) return;
    this.group.position.set(...robot.p_world);
    this.group.rotation.z = robot.yaw_rad;
  }
}

function arrowShape() {
  const at = (angle, radius) => [radius * Math.cos(angle), radius * Math.sin(angle)];
  const shape = new Shape();
  shape.moveTo(...at(0, 0.5));
  shape.lineTo(...at(2.3, 0.34));
  shape.lineTo(...at(0, -0.08));
  shape.lineTo(...at(-2.3, 0.34));
  shape.closePath();
  return shape;
}
