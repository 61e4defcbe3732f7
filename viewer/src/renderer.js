// SPDX-License-Identifier: MIT
// Draws with three.js: voxel faces, wide lines, the robot. The number of draw calls is constant.
import {
  Color, ColorManagement, DoubleSide, GLSL3, GreaterDepth, InstancedBufferGeometry, InstancedInterleavedBuffer,
  InterleavedBufferAttribute, LinearSRGBColorSpace, Mesh, RawShaderMaterial, Scene, Vector2,
  WebGLRenderer,
} from "three";

import { FacePool } from "./face_pool.js";
import { Robot } from "./robot.js";
import { FACE_FRAGMENT, FACE_VERTEX, LINE_FRAGMENT, LINE_VERTEX } from "./shaders.js";

/// Floats of a line: from, to (three each), red, green, blue, alpha, width [px].
export const LINE_FLOATS = 11;
const LINE_PARTS = [["a_from", 3], ["a_to", 3], ["a_colour", 4], ["a_width", 1]];
const MAX_LEVELS = 8;  // as in FACE_VERTEX

// Colours come from the page's style and are drawn unchanged.
ColorManagement.enabled = false;

export class Renderer {
  /// Throws where WebGL 2 is not available.
  constructor(canvas) {
    this.three = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.three.outputColorSpace = LinearSRGBColorSpace;
    this.scene = new Scene();
    this.faces = new FacePool();
    this.faceUniforms = {
      u_voxel: { value: 0 }, u_colours: { value: [] }, u_walkable: { value: [0, 0, 0] },
      u_inflated: { value: [0, 0, 0] }, u_levels: { value: new Float32Array(MAX_LEVELS) },
      u_levelCount: { value: 0 }, u_cut: { value: 0 }, u_spread: { value: 0 },
      u_lowFloor: { value: 0 }, u_highFloor: { value: 0 },
    };
    this.add(new Mesh(this.faces.geometry, new RawShaderMaterial({
      glslVersion: GLSL3, uniforms: this.faceUniforms, vertexShader: FACE_VERTEX,
      fragmentShader: FACE_FRAGMENT, side: DoubleSide,  // corners go round either way
    })), 0);
    this.size = new Vector2(1, 1);
    // Lines behind voxels show faintly.
    this.lines = [this.lineMesh(0.28, { depthFunc: GreaterDepth }), this.lineMesh(1, {})];
    this.lines.forEach((mesh, i) => this.add(mesh, 1 + i));
    this.robot = new Robot();
    this.scene.add(this.robot.group);
  }

  /// Draw calls of the last frame.
  get calls() {
    return this.three.info.render.calls;
  }

  add(mesh, order) {
    mesh.frustumCulled = false;  // shaders move the vertices
    mesh.renderOrder = order;
    this.scene.add(mesh);
  }

  lineMesh(alpha, options) {
    return new Mesh(new InstancedBufferGeometry(), new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: LINE_VERTEX, fragmentShader: LINE_FRAGMENT,
      uniforms: { u_size: { value: this.size }, u_alpha: { value: alpha } },
      transparent: true, depthWrite: false, side: DoubleSide, ...options,
    }));
  }

  setBlock(block, bytes) {
    this.faces.set(block, bytes);
  }

  /// Removes the map, before another run is shown.
  clearBlocks() {
    this.faces.clear();
  }

  resize(width, height, ratio) {
    this.three.setPixelRatio(ratio);
    this.three.setSize(Math.max(1, width), Math.max(1, height), false);
    this.size.set(Math.max(1, width), Math.max(1, height));
  }

  /// view: {background, voxel_m, colours, walkable, inflated, levels, cut, spread, lowFloor,
  /// highFloor}; lines as one array of LINE_FLOATS each; robot from SceneBuilder.
  draw(camera, view, { lines, robot }) {
    const u = this.faceUniforms, levels = view.levels.slice(0, MAX_LEVELS);
    u.u_voxel.value = view.voxel_m;
    u.u_colours.value = view.colours.flat();
    u.u_walkable.value = view.walkable;
    u.u_inflated.value = view.inflated;
    u.u_levels.value.fill(0).set(levels);
    u.u_levelCount.value = levels.length;
    u.u_cut.value = view.cut;
    u.u_spread.value = view.spread;
    u.u_lowFloor.value = view.lowFloor;
    u.u_highFloor.value = view.highFloor;
    this.setLines(lines);
    this.robot.place(robot);
    this.three.setClearColor(new Color(...view.background));
    this.three.render(this.scene, camera);
  }

  setLines(lines) {
    const count = lines.length / LINE_FLOATS;
    if (!this.lineBuffer || this.lineBuffer.count < count) this.growLines(2 * count);
    this.lineBuffer.array.set(lines);
    this.lineBuffer.clearUpdateRanges();
    this.lineBuffer.addUpdateRange(0, lines.length);
    this.lineBuffer.needsUpdate = true;
    this.lines[0].geometry.instanceCount = count;
    for (const mesh of this.lines) mesh.visible = count > 0;
  }

  growLines(count) {
    const capacity = Math.max(256, count), geometry = new InstancedBufferGeometry();
    this.lineBuffer = new InstancedInterleavedBuffer(
      new Float32Array(LINE_FLOATS * capacity), LINE_FLOATS);
    let offset = 0;
    for (const [name, size] of LINE_PARTS) {
      geometry.setAttribute(name, new InterleavedBufferAttribute(this.lineBuffer, size, offset));
      offset += size;
    }
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    for (const mesh of this.lines) {
      mesh.geometry.dispose();
      mesh.geometry = geometry;
    }
  }
}
