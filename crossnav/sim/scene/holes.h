// SPDX-License-Identifier: MIT
// Where a scene's surfaces have holes: textures whose pixels are not all opaque (fences, leaves).
#pragma once

#include <algorithm>
#include <cmath>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

inline bool HasHoles(const Scene& scene, std::size_t triangle) {
  const Material& m = scene.materials[scene.mesh.triangle_material[triangle]];
  return m.texture >= 0 && !scene.mesh.uvs.empty() &&
         !scene.textures[static_cast<std::size_t>(m.texture)].opaque.empty();
}

/// At barycentric (s, t), weights of the second and third corner, of a triangle that has holes.
inline bool IsHole(const Scene& scene, std::uint32_t triangle, float s, float t) {
  const TriangleMesh& mesh = scene.mesh;
  const Material& m = scene.materials[mesh.triangle_material[triangle]];
  const MaskImage& opaque = scene.textures[static_cast<std::size_t>(m.texture)].opaque;
  const auto& corner = mesh.triangles[triangle];
  const auto &a = mesh.uvs[corner[0]], &b = mesh.uvs[corner[1]], &c = mesh.uvs[corner[2]];
  const float u = (1 - s - t) * a[0] + s * b[0] + t * c[0];
  const float v = (1 - s - t) * a[1] + s * b[1] + t * c[1];
  const auto pick = [](float x, int size) {
    return std::min(static_cast<int>((x - std::floor(x)) * static_cast<float>(size)), size - 1);
  };
  return opaque.At(pick(u, opaque.width), pick(v, opaque.height)) == 0;
}

}  // namespace crossnav::sim
