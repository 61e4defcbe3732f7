// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/floor_parts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "crossnav/sim/navmesh/surface_samples.h"

namespace crossnav::evaluation {
namespace {

std::vector<sim::SurfaceSample> SamplesOf(const sim::NavMesh& navmesh, double grid_m) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const auto& triangle : navmesh.Triangles()) {
    const auto& p = triangle.p_world;
    triangles.push_back({p[0].cast<double>(), p[1].cast<double>(), p[2].cast<double>()});
  }
  return sim::SampleSurface(triangles, grid_m);
}

}  // namespace

FloorParts::FloorParts(const sim::NavMesh& navmesh) : grid_m_(navmesh.settings().cell_m) {
  const auto samples = SamplesOf(navmesh, grid_m_);
  std::vector<int> floor;
  for (const auto& s : samples) {
    floor.push_back(navmesh.FloorOf({s.x * grid_m_, s.y * grid_m_, s.z}));
  }
  int count = 0;
  const auto part = sim::Components(
      samples, count, [](std::size_t) { return true; },
      [&](std::size_t a, std::size_t b) { return floor[a] == floor[b]; });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    points_.push_back({samples[i].x, samples[i].y, static_cast<float>(samples[i].z), part[i]});
  }
}

int FloorParts::PartAt(const Vector3d& p_world) const {
  constexpr int kReach = 2;  // chosen: cells; the surface's border lies between two points
  constexpr double kStep_m = 0.3;
  const auto cell = [&](double m) { return static_cast<int>(std::lround(m / grid_m_)); };
  const auto before = [](const Point& a, const Point& b) {
    return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z);
  };
  int part = -1;
  double nearest_m = kStep_m + kReach * 2 * grid_m_;
  for (int x = cell(p_world.x()) - kReach; x <= cell(p_world.x()) + kReach; ++x) {
    for (int y = cell(p_world.y()) - kReach; y <= cell(p_world.y()) + kReach; ++y) {
      const Point low{x, y, static_cast<float>(p_world.z() - kStep_m), 0};
      for (auto it = std::lower_bound(points_.begin(), points_.end(), low, before);
           it != points_.end() && it->x == x && it->y == y; ++it) {
        const double gap_m = (Place(*it) - p_world).norm();
        if (std::abs(it->z - p_world.z()) > kStep_m || gap_m >= nearest_m) continue;
        nearest_m = gap_m;
        part = it->part;
      }
    }
  }
  return part;
}

}  // namespace crossnav::evaluation
