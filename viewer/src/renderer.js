// SPDX-License-Identifier: MIT
// Draws with WebGL 2: voxel faces (four vertices each), wide lines, shaded triangles.
import { FLOOR_MARGIN_M } from "./data.js";
import { COVERED, FACE_BYTES } from "./voxels.js";

// Floors are cut at a height above their level and can be moved apart; the same rule as in scene.js.
const FLOOR_RULE = `
uniform float u_levels[8];
uniform int u_levelCount;
uniform float u_cut, u_spread;
uniform int u_lowFloor, u_highFloor;
int floorOf(float z) {
  int f = 0;
  for (int i = 1; i < 8; ++i) if (i < u_levelCount && z > u_levels[i] - ${FLOOR_MARGIN_M}) f = i;
  return f;
}`;

const FACE_VERTEX = `#version 300 es
precision highp float;
in vec3 a_key;
in vec2 a_face;
uniform mat4 u_clip;
uniform float u_voxel;
uniform vec3 u_colours[8];
uniform vec3 u_walkable, u_inflated;
${FLOOR_RULE}
out vec3 v_colour;
out vec2 v_uv;
const vec3 NORMAL[5] = vec3[5](vec3(1,0,0), vec3(-1,0,0), vec3(0,1,0), vec3(0,-1,0), vec3(0,0,1));
void main() {
  int direction = int(a_face.x), packed = int(a_face.y);
  bool isCovered = direction >= ${COVERED};
  if (isCovered) direction -= ${COVERED};
  int state = packed & 7, above = packed >> 4;
  v_uv = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1);
  vec3 n = NORMAL[direction];
  vec3 s = direction < 2 ? vec3(0,1,0) : vec3(1,0,0);
  vec3 t = direction < 4 ? vec3(0,0,1) : vec3(0,1,0);
  vec3 corner = max(n, vec3(0)) + s * v_uv.x + t * v_uv.y;
  float z = (a_key.z + 0.5) * u_voxel;
  int f = floorOf(z);
  bool isStair = state >= 5;
  float height = z - u_levels[f];
  bool isCut = !isStair && height > u_cut;
  bool isLid = !isStair && height + u_voxel > u_cut;
  if (f < u_lowFloor || f > u_highFloor || isCut || (isCovered && !isLid)) {
    gl_Position = vec4(2, 2, 2, 1);
    return;
  }
  vec3 p = (a_key + corner) * u_voxel;
  p.z += float(f) * u_spread;
  gl_Position = u_clip * vec4(p, 1);
  vec3 colour = u_colours[state];
  int airState = above & 7;
  bool inflated = above >= 8;
  if (direction == 4 && state == 1 && !isCovered && airState == 2) colour = inflated ? u_inflated : u_walkable;
  if (direction == 4 && isStair && airState == 3 && inflated) colour = mix(colour, u_inflated, 0.4);
  float light = direction == 4 ? 1.0 : direction < 2 ? 0.80 : 0.68;
  light *= 0.93 + 0.07 * clamp(height / 1.6, 0.0, 1.0);
  v_colour = colour * light;
}`;

const FACE_FRAGMENT = `#version 300 es
precision highp float;
in vec3 v_colour;
in vec2 v_uv;
out vec4 colour;
void main() {
  vec2 width = fwidth(v_uv);
  vec2 edge = min(v_uv, 1.0 - v_uv) / max(width, 1e-6);
  float line = 1.0 - clamp(min(edge.x, edge.y), 0.0, 1.0);
  float near = clamp(0.35 - max(width.x, width.y) * 2.0, 0.0, 0.18);
  colour = vec4(v_colour * (1.0 - near * line), 1);
}`;

const LINE_VERTEX = `#version 300 es
precision highp float;
in vec3 a_from, a_to;
in vec4 a_colour;
in float a_width;
uniform mat4 u_clip;
uniform vec2 u_size;
uniform float u_alpha;
out vec4 v_colour;
void main() {
  vec4 p = u_clip * vec4(a_from, 1), q = u_clip * vec4(a_to, 1);
  const float near = 0.02;
  if (p.w < near && q.w < near) { gl_Position = vec4(2, 2, 2, 1); return; }
  if (p.w < near) p = mix(p, q, (near - p.w) / (q.w - p.w));
  if (q.w < near) q = mix(q, p, (near - q.w) / (p.w - q.w));
  vec2 along = (q.xy / q.w - p.xy / p.w) * u_size;
  float length_px = length(along);
  along = length_px > 1e-4 ? along / length_px : vec2(1, 0);
  float end = float(gl_VertexID & 1), side = float(gl_VertexID >> 1) * 2.0 - 1.0;
  vec4 at = mix(p, q, end);
  // Ends reach a little further, so that bends close.
  vec2 offset = vec2(-along.y, along.x) * side + along * (end * 2.0 - 1.0) * 0.45;
  at.xy += offset * a_width / u_size * at.w;
  at.z -= 0.0006 * at.w;
  gl_Position = at;
  v_colour = vec4(a_colour.rgb, a_colour.a * u_alpha);
}`;

const SOLID_VERTEX = `#version 300 es
precision highp float;
in vec3 a_position, a_normal, a_rgb;
uniform mat4 u_clip;
out vec4 v_colour;
void main() {
  float light = 0.72 + 0.28 * dot(normalize(a_normal), normalize(vec3(0.4, 0.2, 0.9)));
  v_colour = vec4(a_rgb * light, 1);
  gl_Position = u_clip * vec4(a_position, 1);
}`;

const PLAIN_FRAGMENT = `#version 300 es
precision highp float;
in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }`;

export const LINE_FLOATS = 11;
export const SOLID_FLOATS = 9;

function makeProgram(gl, vertex, fragment, attributes) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  attributes.forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const uniforms = {};
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
  for (let i = 0; i < count; ++i) {
    const name = gl.getActiveUniform(program, i).name.replace("[0]", "");
    uniforms[name] = gl.getUniformLocation(program, name);
  }
  return { program, uniforms };
}

/// Buffer of float attributes: sizes = [3, 3, ...], `divisor` 1 for one value an instance.
function floatArray(gl, sizes, divisor) {
  const vao = gl.createVertexArray(), buffer = gl.createBuffer();
  gl.bindVertexArray(vao);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  const stride = 4 * sizes.reduce((a, b) => a + b, 0);
  let offset = 0;
  sizes.forEach((size, i) => {
    gl.enableVertexAttribArray(i);
    gl.vertexAttribPointer(i, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(i, divisor);
    offset += 4 * size;
  });
  return { vao, buffer };
}

/// Every face's bytes four times: one instance a face would be slow, four vertices are too few.
function fourfold(bytes) {
  const faces = new BigUint64Array(bytes.buffer), out = new BigUint64Array(4 * faces.length);
  for (let i = 0; i < faces.length; ++i) out.fill(faces[i], 4 * i, 4 * i + 4);
  return out;
}

export class Renderer {
  /// Throws where WebGL 2 is not to be had.
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("WebGL 2 is not available");
    this.gl = gl;
    this.canvas = canvas;
    this.faces = makeProgram(gl, FACE_VERTEX, FACE_FRAGMENT, ["a_key", "a_face"]);
    this.lines = makeProgram(gl, LINE_VERTEX, PLAIN_FRAGMENT, ["a_from", "a_to", "a_colour", "a_width"]);
    this.solids = makeProgram(gl, SOLID_VERTEX, PLAIN_FRAGMENT, ["a_position", "a_normal", "a_rgb"]);
    this.lineArray = floatArray(gl, [3, 3, 4, 1], 1);
    this.solidArray = floatArray(gl, [3, 3, 3], 0);
    this.blocks = new Map();
    this.corners = { buffer: gl.createBuffer(), faces: 0 };
    this.calls = 0;  // draw calls of the last frame
  }

  setBlock(block, bytes) {
    const gl = this.gl;
    let entry = this.blocks.get(block);
    if (!entry) {
      entry = { vao: gl.createVertexArray(), buffer: gl.createBuffer(), count: 0 };
      gl.bindVertexArray(entry.vao);
      gl.bindBuffer(gl.ARRAY_BUFFER, entry.buffer);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 3, gl.SHORT, false, FACE_BYTES, 0);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribPointer(1, 2, gl.UNSIGNED_BYTE, false, FACE_BYTES, 6);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners.buffer);
      this.blocks.set(block, entry);
    }
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, entry.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, fourfold(bytes), gl.DYNAMIC_DRAW);
    entry.count = bytes.length / FACE_BYTES;
    this.ensureCorners(entry.count);
  }

  /// Forgets the map, as another run's is shown next.
  clearBlocks() {
    for (const { vao, buffer } of this.blocks.values()) {
      this.gl.deleteVertexArray(vao);
      this.gl.deleteBuffer(buffer);
    }
    this.blocks.clear();
  }

  /// Grows the indices that all blocks share: two triangles a face.
  ensureCorners(faces) {
    if (faces <= this.corners.faces) return;
    const count = Math.max(1024, 2 * faces), indices = new Uint32Array(6 * count);
    for (let i = 0; i < count; ++i) indices.set([0, 1, 2, 2, 1, 3].map((k) => 4 * i + k), 6 * i);
    const gl = this.gl;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners.buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    this.corners.faces = count;
  }

  resize(width, height, ratio) {
    const w = Math.max(1, Math.round(width * ratio)), h = Math.max(1, Math.round(height * ratio));
    if (this.canvas.width !== w) this.canvas.width = w;
    if (this.canvas.height !== h) this.canvas.height = h;
  }

  /// view: {matrix, background, voxel_m, colours, walkable, inflated, levels, cut, spread,
  /// lowFloor, highFloor, ratio}; lines and triangles as flat arrays of LINE_FLOATS and SOLID_FLOATS.
  draw(view, lines, triangles) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...view.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.calls = 3;  // solids, lines twice
    this.drawFaces(view);
    this.drawTriangles(view, triangles);
    this.drawLines(view, lines);
    gl.bindVertexArray(null);
  }

  drawFaces(view) {
    const gl = this.gl, u = this.faces.uniforms;
    gl.disable(gl.BLEND);
    gl.useProgram(this.faces.program);
    gl.uniformMatrix4fv(u.u_clip, false, view.matrix);
    gl.uniform1f(u.u_voxel, view.voxel_m);
    gl.uniform3fv(u.u_colours, view.colours.flat());
    gl.uniform3fv(u.u_walkable, view.walkable);
    gl.uniform3fv(u.u_inflated, view.inflated);
    const levels = new Float32Array(8);
    levels.set(view.levels.slice(0, 8));
    gl.uniform1fv(u.u_levels, levels);
    gl.uniform1i(u.u_levelCount, Math.min(8, view.levels.length));
    gl.uniform1f(u.u_cut, view.cut);
    gl.uniform1f(u.u_spread, view.spread);
    gl.uniform1i(u.u_lowFloor, view.lowFloor);
    gl.uniform1i(u.u_highFloor, view.highFloor);
    for (const entry of this.blocks.values()) {
      if (entry.count === 0) continue;
      gl.bindVertexArray(entry.vao);
      gl.drawElements(gl.TRIANGLES, 6 * entry.count, gl.UNSIGNED_INT, 0);
      ++this.calls;
    }
  }

  drawTriangles(view, triangles) {
    const gl = this.gl;
    gl.useProgram(this.solids.program);
    gl.uniformMatrix4fv(this.solids.uniforms.u_clip, false, view.matrix);
    gl.bindVertexArray(this.solidArray.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.solidArray.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(triangles), gl.DYNAMIC_DRAW);
    gl.drawArrays(gl.TRIANGLES, 0, triangles.length / SOLID_FLOATS);
  }

  /// Twice: what is hidden by voxels shows through faintly.
  drawLines(view, lines) {
    const gl = this.gl, u = this.lines.uniforms;
    gl.useProgram(this.lines.program);
    gl.uniformMatrix4fv(u.u_clip, false, view.matrix);
    gl.uniform2f(u.u_size, this.canvas.width / view.ratio, this.canvas.height / view.ratio);
    gl.bindVertexArray(this.lineArray.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lineArray.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(lines), gl.DYNAMIC_DRAW);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    for (const hidden of [true, false]) {
      gl.depthFunc(hidden ? gl.GREATER : gl.LEQUAL);
      gl.uniform1f(u.u_alpha, hidden ? 0.28 : 1);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.length / LINE_FLOATS);
    }
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
  }
}
