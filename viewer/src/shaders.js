// SPDX-License-Identifier: MIT
// The shaders of the map and of wide lines. Attributes and uniforms are set in renderer.js.
import { FLOOR_MARGIN_M } from "./data.js";
import { COVERED } from "./voxels.js";

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

export const FACE_VERTEX = `precision highp float;
in vec4 a_face;  // voxel; direction and value in one int16
uniform mat4 projectionMatrix, modelViewMatrix;
uniform float u_voxel;
uniform vec3 u_colours[8];
uniform vec3 u_walkable, u_inflated;
${FLOOR_RULE}
out vec3 v_colour;
out vec2 v_uv;
const vec3 NORMAL[5] = vec3[5](vec3(1,0,0), vec3(-1,0,0), vec3(0,1,0), vec3(0,-1,0), vec3(0,0,1));
void main() {
  vec3 key = a_face.xyz;
  int both = int(a_face.w) & 0xffff, direction = both & 255, packed = both >> 8;
  bool isCovered = direction >= ${COVERED};
  if (isCovered) direction -= ${COVERED};
  int state = packed & 7, above = packed >> 4;
  v_uv = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1);
  vec3 n = NORMAL[direction];
  vec3 s = direction < 2 ? vec3(0,1,0) : vec3(1,0,0);
  vec3 t = direction < 4 ? vec3(0,0,1) : vec3(0,1,0);
  vec3 corner = max(n, vec3(0)) + s * v_uv.x + t * v_uv.y;
  float z = (key.z + 0.5) * u_voxel;
  int f = floorOf(z);
  bool isStair = state >= 5;
  float height = z - u_levels[f];
  bool isCut = !isStair && height > u_cut;
  bool isLid = !isStair && height + u_voxel > u_cut;
  if (state == 0 || f < u_lowFloor || f > u_highFloor || isCut || (isCovered && !isLid)) {
    gl_Position = vec4(2, 2, 2, 1);
    return;
  }
  vec3 p = (key + corner) * u_voxel;
  p.z += float(f) * u_spread;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(p, 1);
  vec3 colour = u_colours[state];
  int airState = above & 7;
  bool inflated = above >= 8;
  if (direction == 4 && state == 1 && !isCovered && airState == 2) colour = inflated ? u_inflated : u_walkable;
  if (direction == 4 && isStair && airState == 3 && inflated) colour = mix(colour, u_inflated, 0.4);
  float light = direction == 4 ? 1.0 : direction < 2 ? 0.80 : 0.68;
  light *= 0.93 + 0.07 * clamp(height / 1.6, 0.0, 1.0);
  v_colour = colour * light;
}`;

export const FACE_FRAGMENT = `precision highp float;
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

export const LINE_VERTEX = `precision highp float;
in vec3 a_from, a_to;
in vec4 a_colour;
in float a_width;
uniform mat4 projectionMatrix, modelViewMatrix;
uniform vec2 u_size;
uniform float u_alpha;
out vec4 v_colour;
void main() {
  mat4 clip = projectionMatrix * modelViewMatrix;
  vec4 p = clip * vec4(a_from, 1), q = clip * vec4(a_to, 1);
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

export const LINE_FRAGMENT = `precision highp float;
in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }`;
