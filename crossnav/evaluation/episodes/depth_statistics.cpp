// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/depth_statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crossnav::evaluation {
namespace {

constexpr int kReach_px = 3, kStep_px = 3;
constexpr double kOneThing = 0.08;  // chosen: spread of depth in a window that is one surface
constexpr double kJump = 0.2;       // chosen: share by which the sides of an edge differ
constexpr double kBetween = 0.15;   // chosen: share of a jump that belongs to its sides
constexpr std::size_t kLeast = 100;

/// 1 / z = c + a du + b dv over the window, without its middle.
struct WindowFit {
  double c = 0, a = 0, b = 0;
};

std::optional<WindowFit> FitWindow(const DepthImage& depth_m, int u, int v) {
  double sum = 0, by_u = 0, by_v = 0, squares = 0;
  float least = depth_m.At(u, v), most = least;
  int count = 0;
  for (int dv = -kReach_px; dv <= kReach_px; ++dv)
    for (int du = -kReach_px; du <= kReach_px; ++du) {
      const float z_m = depth_m.At(u + du, v + dv);
      if (!(z_m > 0)) return std::nullopt;
      least = std::min(least, z_m), most = std::max(most, z_m);
      if (du == 0 && dv == 0) continue;
      sum += 1 / z_m, by_u += du / z_m, by_v += dv / z_m;
      squares += du * du, ++count;
    }
  if (most - least > kOneThing * least) return std::nullopt;
  return WindowFit{sum / count, by_u / squares, by_v / squares};
}

/// Angle between the pixel's ray and the normal of the plane [deg].
double AngleOf(const WindowFit& fit, const CameraIntrinsics& camera, int u, int v) {
  const double x = (u - camera.cx) / camera.fx, y = (v - camera.cy) / camera.fy;
  Vector3d n(fit.a * camera.fx, fit.b * camera.fy, 0);  // n . p = 1 on the plane
  n.z() = fit.c - n.x() * x - n.y() * y;
  const Vector3d ray(x, y, 1);
  return RadToDeg(std::acos(std::min(1.0, std::abs(n.dot(ray)) / (n.norm() * ray.norm()))));
}

template <std::size_t N>
int BinOf(const std::array<double, N>& edges, double value) {
  for (std::size_t k = 1; k < N; ++k)
    if (value >= edges[k - 1] && value < edges[k]) return static_cast<int>(k) - 1;
  return -1;
}

/// A jump within a few pixels of (u, v) along its row, and whether the pixel is of neither side.
void AddEdge(const DepthImage& depth_m, int u, int v, DepthStatistics* s) {
  const float left = depth_m.At(u - 2, v), right = depth_m.At(u + 2, v), here = depth_m.At(u, v);
  const float near = std::min(left, right), far = std::max(left, right);
  if (!(near > 0 && here > 0) || far - near < kJump * near) return;
  const double share = (here - near) / (far - near);
  ++s->edges;
  s->flying += share > kBetween && share < 1 - kBetween;
}

}  // namespace

double DepthStatistics::SigmaOf(int distance, int angle) const {
  std::vector<double> off_m = residuals_m[distance][angle];
  if (off_m.size() < kLeast) return 0;
  const auto middle = off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2);
  std::nth_element(off_m.begin(), middle, off_m.end());
  return 1.48 * *middle;
}

void AddFrame(const Observation& obs, DepthStatistics* s) {
  const DepthImage& depth_m = obs.depth_m;
  const bool has_light = obs.rgb.width == depth_m.width && obs.rgb.height == depth_m.height;
  for (int v = kReach_px; v + kReach_px < depth_m.height; v += kStep_px)
    for (int u = kReach_px; u + kReach_px < depth_m.width; u += kStep_px) {
      const double z_m = depth_m.At(u, v);
      if (has_light) {
        const Rgb8& c = obs.rgb.At(u, v);
        const double light = 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
        std::size_t bin = 0;
        while (bin + 1 < kLights.size() && light >= kLights[bin]) ++bin;
        ++s->lit[bin];
        s->lost[bin] += !(z_m > 0);
      }
      AddEdge(depth_m, u, v, s);
      const auto fit = FitWindow(depth_m, u, v);
      if (!fit || fit->c <= 0) continue;
      const int distance = BinOf(kDistances_m, z_m);
      const int angle = BinOf(kAngles_deg, AngleOf(*fit, obs.camera, u, v));
      if (distance >= 0 && angle >= 0)
        s->residuals_m[distance][angle].push_back(std::abs(z_m - 1 / fit->c));
    }
}

}  // namespace crossnav::evaluation
