// SPDX-License-Identifier: MIT
// Colour of a surface point: material, texture and vertex colour under a lamp on the camera plus a
// little light from above and from one side, so that walls, floor and edges are distinguishable.
// Unlit surfaces (KHR_materials_unlit: the colours of a scan include light) keep their colour.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

struct Colour3f {
  float r = 0, g = 0, b = 0;
};

/// Bilinear, repeating; `u`, `v` finite.
inline Colour3f SampleTexture(const RgbImage& image, float u, float v) {
  const float x = (u - std::floor(u)) * static_cast<float>(image.width) - 0.5F;
  const float y = (v - std::floor(v)) * static_cast<float>(image.height) - 0.5F;
  const float x_floor = std::floor(x), y_floor = std::floor(y);
  const float fx = x - x_floor, fy = y - y_floor;
  const auto wrap = [](int i, int n) { return i < 0 ? i + n : (i >= n ? i - n : i); };
  const int x0 = wrap(static_cast<int>(x_floor), image.width);
  const int y0 = wrap(static_cast<int>(y_floor), image.height);
  const int x1 = wrap(x0 + 1, image.width), y1 = wrap(y0 + 1, image.height);
  const Rgb8 &a = image.At(x0, y0), &b = image.At(x1, y0), &c = image.At(x0, y1),
             &d = image.At(x1, y1);
  const float wa = (1 - fx) * (1 - fy), wb = fx * (1 - fy), wc = (1 - fx) * fy, wd = fx * fy;
  return {wa * a.r + wb * b.r + wc * c.r + wd * d.r, wa * a.g + wb * b.g + wc * c.g + wd * d.g,
          wa * a.b + wb * b.b + wc * c.b + wd * d.b};
}

/// Unlit colour at barycentric (s, t) of `triangle` (weights of its second and third corner).
inline Colour3f SurfaceColour(const Scene& scene, std::uint32_t triangle, float s, float t) {
  const TriangleMesh& mesh = scene.mesh;
  const Material& material = scene.materials[mesh.triangle_material[triangle]];
  const auto& corner = mesh.triangles[triangle];
  const float w0 = 1 - s - t;
  Colour3f colour{static_cast<float>(material.colour.r), static_cast<float>(material.colour.g),
                  static_cast<float>(material.colour.b)};
  const auto multiply = [&colour](const Colour3f& by) {
    colour = {colour.r * by.r / 255, colour.g * by.g / 255, colour.b * by.b / 255};
  };
  if (material.texture >= 0 && !mesh.uvs.empty()) {
    const auto &a = mesh.uvs[corner[0]], &b = mesh.uvs[corner[1]], &c = mesh.uvs[corner[2]];
    multiply(SampleTexture(scene.textures[static_cast<std::size_t>(material.texture)].rgb,
                           w0 * a[0] + s * b[0] + t * c[0], w0 * a[1] + s * b[1] + t * c[1]));
  }
  if (!mesh.vertex_colours.empty()) {
    const Rgb8 &a = mesh.vertex_colours[corner[0]], &b = mesh.vertex_colours[corner[1]],
               &c = mesh.vertex_colours[corner[2]];
    multiply(
        {w0 * a.r + s * b.r + t * c.r, w0 * a.g + s * b.g + t * c.g, w0 * a.b + s * b.b + t * c.b});
  }
  return colour;
}

/// Share of light [0, 1] on a surface with normal `n` seen along the ray `d` (world, any lengths).
inline float Light(const Vector3f& n, const Vector3f& d) {
  const float turned = n.x() * d.x() + n.y() * d.y() + n.z() * d.z();
  const float n2 = n.x() * n.x() + n.y() * n.y() + n.z() * n.z() + 1e-30F;
  const float d2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
  const float one_over_n = 1 / std::sqrt(n2);
  const float facing = std::abs(turned) * one_over_n / std::sqrt(d2);
  const float side = 0.10F * n.z() + 0.06F * n.x() + 0.03F * n.y();
  // The normal is turned to the viewer: meshes are not wound consistently. The sum stays in (0, 1).
  return 0.52F + 0.32F * facing + std::copysign(one_over_n, -turned) * side;
}

}  // namespace crossnav::sim
