// SPDX-License-Identifier: MIT
// Scenes of a few boxes, built in code. World frame, metres.
#pragma once

#include <string>

#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim::test {

class MicroScene {
 public:
  MicroScene() { scene_.id = "micro"; }

  /// Following triangles belong to a new instance; returns its id.
  int Begin(const std::string& name, const std::string& category = "") {
    scene_.instances.push_back(
        {static_cast<int>(scene_.instances.size()) + 1, name, category, 0, {}});
    return scene_.instances.back().id;
  }

  void Triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    TriangleMesh& mesh = scene_.mesh;
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vector3d& p : {a, b, c}) mesh.vertices.push_back(p.cast<float>());
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangle_material.push_back(material_);
    mesh.triangle_instance.push_back(scene_.instances.empty() ? 0 : scene_.instances.back().id);
  }

  void Quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
    Triangle(a, b, c);
    Triangle(a, c, d);
  }

  void Box(const Vector3d& lo, const Vector3d& hi) {
    const auto at = [&](int x, int y, int z) {
      return Vector3d(x != 0 ? hi.x() : lo.x(), y != 0 ? hi.y() : lo.y(), z != 0 ? hi.z() : lo.z());
    };
    Quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));  // top
    Quad(at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0));  // bottom
    Quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
    Quad(at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1));
    Quad(at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1));
    Quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  }

  /// Horizontal rectangle, seen from above.
  void Ground(double x0, double y0, double x1, double y1, double z = 0) {
    Quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
  }

  /// Floor, ceiling and four walls around [x0, x1] x [y0, y1] x [0, height].
  void Room(double x0, double y0, double x1, double y1, double height = 2.6, double z = 0) {
    Begin("floor");
    Ground(x0, y0, x1, y1, z);
    Begin("ceiling");
    Ground(x0, y0, x1, y1, z + height);
    Begin("wall");
    const double t = 0.1;
    Box({x0 - t, y0 - t, z}, {x1 + t, y0, z + height});
    Box({x0 - t, y1, z}, {x1 + t, y1 + t, z + height});
    Box({x0 - t, y0, z}, {x0, y1, z + height});
    Box({x1, y0, z}, {x1 + t, y1, z + height});
  }

  void SetMaterial(std::uint16_t material) { material_ = material; }
  Scene& scene() { return scene_; }

  Scene Finish() {
    UpdateDerived(scene_);
    return scene_;
  }

 private:
  Scene scene_;
  std::uint16_t material_ = 0;
};

/// Risers and going of TwoFloors' flight.
constexpr int kRisers = 17;
constexpr double kRise_m = 3.0 / kRisers, kGoing_m = 0.26;
/// x of the first riser; the flight climbs towards +x between y = 0 and y = 1.
constexpr double kFlight_x = 2.0;
constexpr double kFlightEnd_x = kFlight_x + kRisers * kGoing_m;

/// A lower floor [0, 10] x [0, 6] and, reached by a straight flight of 17 stairs along y in [0, 1],
/// an upper one over [kFlightEnd_x, 10] x [0, 6] and [0, 10] x [1, 6] at z = 3. Open above.
inline Scene TwoFloors() {
  MicroScene m;
  m.Begin("floor");
  m.Ground(0, 0, 10, 6, 0);
  m.Begin("floor");
  m.Box({kFlightEnd_x, 0, 2.85}, {10, 6, 3.0});
  m.Box({0, 1.1, 2.85}, {kFlightEnd_x, 6, 3.0});
  m.Begin("stairs");
  for (int i = 0; i < kRisers; ++i) {
    m.Box({kFlight_x + i * kGoing_m, 0, 0}, {kFlight_x + (i + 1) * kGoing_m, 1, (i + 1) * kRise_m});
  }
  m.Begin("wall");  // beside the flight, and a parapet along the opening
  m.Box({kFlight_x, 1.0, 0}, {kFlightEnd_x, 1.1, 4.0});
  m.Box({0, 1.0, 2.85}, {kFlight_x, 1.1, 4.0});
  m.Begin("wall");
  m.Box({-0.1, -0.1, 0}, {10.1, 0, 5.6});
  m.Box({-0.1, 6, 0}, {10.1, 6.1, 5.6});
  m.Box({-0.1, 0, 0}, {0, 6, 5.6});
  m.Box({10, 0, 0}, {10.1, 6, 5.6});
  m.Begin("bed", "bed");
  m.Box({7, 4, 3.0}, {9, 5.4, 3.5});
  m.Begin("couch", "sofa");
  m.Box({6, 4, 0}, {8, 5, 0.8});
  return m.Finish();
}

}  // namespace crossnav::sim::test
