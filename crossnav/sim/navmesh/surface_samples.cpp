// SPDX-License-Identifier: MIT
#include "crossnav/sim/navmesh/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace crossnav::sim {
namespace {

constexpr double kSameStep_m = 0.30;  // neighbours further apart in height are not connected

struct ByPlace {
  bool operator()(const SurfaceSample& a, const SurfaceSample& b) const {
    return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z);
  }
};

void SampleTriangle(const std::array<Vector3d, 3>& t, double grid_m,
                    std::vector<SurfaceSample>& out) {
  const double det =
      (t[1].x() - t[0].x()) * (t[2].y() - t[0].y()) - (t[2].x() - t[0].x()) * (t[1].y() - t[0].y());
  if (std::abs(det) < 1e-12) return;
  const auto [x_low, x_high] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [y_low, y_high] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  for (int x = static_cast<int>(std::ceil(x_low / grid_m)); x * grid_m <= x_high; ++x) {
    for (int y = static_cast<int>(std::ceil(y_low / grid_m)); y * grid_m <= y_high; ++y) {
      const double px = x * grid_m - t[0].x(), py = y * grid_m - t[0].y();
      const double s = (px * (t[2].y() - t[0].y()) - py * (t[2].x() - t[0].x())) / det;
      const double r = (py * (t[1].x() - t[0].x()) - px * (t[1].y() - t[0].y())) / det;
      if (s < -1e-9 || r < -1e-9 || s + r > 1 + 1e-9) continue;
      out.push_back({x, y, t[0].z() + s * (t[1].z() - t[0].z()) + r * (t[2].z() - t[0].z())});
    }
  }
}

void LinkNeighbours(std::vector<SurfaceSample>& samples) {
  constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (SurfaceSample& s : samples) {
    for (std::size_t k = 0; k < 4; ++k) {
      const SurfaceSample low{s.x + kSteps[k][0], s.y + kSteps[k][1], s.z - kSameStep_m};
      double nearest_m = kSameStep_m;
      for (auto it = std::lower_bound(samples.begin(), samples.end(), low, ByPlace{});
           it != samples.end() && it->x == low.x && it->y == low.y; ++it) {
        if (std::abs(it->z - s.z) > nearest_m) continue;
        nearest_m = std::abs(it->z - s.z);
        s.next[k] = static_cast<int>(it - samples.begin());
      }
    }
  }
}

}  // namespace

std::vector<SurfaceSample> SampleSurface(std::span<const std::array<Vector3d, 3>> triangles,
                                         double grid_m) {
  std::vector<SurfaceSample> samples;
  for (const auto& triangle : triangles) SampleTriangle(triangle, grid_m, samples);
  std::sort(samples.begin(), samples.end(), ByPlace{});
  const auto same = [](const SurfaceSample& a, const SurfaceSample& b) {
    return a.x == b.x && a.y == b.y && std::abs(a.z - b.z) < kSameStep_m;  // edges are shared
  };
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
  LinkNeighbours(samples);
  return samples;
}

}  // namespace crossnav::sim
