// SPDX-License-Identifier: MIT
// Reference of rays: every triangle against one ray; and scenes that are hard to draw.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/core/rng.h"
#include "micro_scene.h"

namespace crossnav::sim::test {

struct OracleHit {
  double t = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();  // next different surface
  double edge = 0;  // smallest barycentric coordinate of the hit, and of near misses
  std::int32_t instance = 0;
};

/// Every triangle against one ray, in double precision. `edge`: distance of the ray to the nearest
/// triangle edge; rays near an edge may fall on either side in single precision.
inline OracleHit CastAll(const Scene& scene, const Vector3d& o, const Vector3d& d) {
  OracleHit hit;
  hit.edge = 1;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const auto& c = scene.mesh.triangles[t];
    const Vector3d a = scene.mesh.vertices[c[0]].cast<double>();
    const Vector3d e1 = scene.mesh.vertices[c[1]].cast<double>() - a;
    const Vector3d e2 = scene.mesh.vertices[c[2]].cast<double>() - a;
    const Vector3d n = e1.cross(e2);
    const double det = -d.dot(n);
    if (std::abs(det) < 1e-14) continue;
    const double distance = (o - a).dot(n) / det;
    const Vector3d dao = (o - a).cross(d);
    const double u = e2.dot(dao) / det, v = -e1.dot(dao) / det;
    const double inside = std::min({u, v, 1 - u - v});
    if (distance <= 0) continue;
    if (std::abs(inside) < 1e-4) hit.edge = std::min(hit.edge, std::abs(inside));
    if (inside < 0) continue;
    if (distance < hit.t) {
      hit.second = hit.t;
      hit.t = distance;
      hit.instance = scene.mesh.triangle_instance[t];
    } else {
      hit.second = std::min(hit.second, distance);
    }
  }
  return hit;
}

/// A room with `count` triangles of some decimetres in it, each an instance of its own.
inline Scene RandomTriangles(std::uint64_t seed, int count = 60) {
  Rng rng(seed);
  MicroScene m;
  m.Room(-3, -3, 3, 3);
  const auto point = [&rng] {
    return Vector3d(rng.Uniform(-3, 3), rng.Uniform(-3, 3), rng.Uniform(0, 2.6));
  };
  for (int i = 0; i < count; ++i) {
    m.Begin("thing");
    const Vector3d a = point();
    const auto near = [&] { return Vector3d(a + 0.3 * (point() - point())); };
    const Vector3d b = near(), c = near();
    m.Triangle(a, b, c);
  }
  return m.Finish();
}

}  // namespace crossnav::sim::test
