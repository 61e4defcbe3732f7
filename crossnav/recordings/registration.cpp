// SPDX-License-Identifier: MIT
#include "crossnav/recordings/registration.h"

#include <algorithm>
#include <cmath>

namespace crossnav::recordings {
namespace {

constexpr double kNearest_m = 0.01;   // chosen: below the range of any depth camera
constexpr double kWidest_px = 64;     // chosen: a square larger than this is a broken calibration
constexpr double kFarthest_px = 1e6;  // limit before conversion to int

/// Pixel of the distorted image for the ideal pixel (u, v).
Eigen::Vector2d Distort(const CameraModel& camera, double u, double v) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const double x = (u - camera.K.cx) / camera.K.fx, y = (v - camera.K.cy) / camera.K.fy;
  const double r2 = x * x + y * y;
  const double radial =
      (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return {camera.K.fx * xd + camera.K.cx, camera.K.fy * yd + camera.K.cy};
}

template <class T>
Image<T> RectifyImage(const Image<T>& image, const CameraModel& camera) {
  if (!camera.IsDistorted()) return image;
  Image<T> out(image.width, image.height);
  for (int v = 0; v < out.height; ++v) {
    for (int u = 0; u < out.width; ++u) {
      const Eigen::Vector2d at = Distort(camera, u, v);
      if (!(at.cwiseAbs().maxCoeff() < kFarthest_px)) continue;
      const int us = static_cast<int>(std::lround(at.x())),
                vs = static_cast<int>(std::lround(at.y()));
      if (image.Contains(us, vs)) out.At(u, v) = image.At(us, vs);
    }
  }
  return out;
}

Eigen::Vector2d Project(const CameraIntrinsics& K, const Vector3d& p) {
  return {K.fx * p.x() / p.z() + K.cx, K.fy * p.y() / p.z() + K.cy};
}

void Put(DepthImage& out, const Eigen::Vector2d& a, const Eigen::Vector2d& b, float depth_m) {
  const Eigen::Vector2d lo = a.cwiseMin(b), hi = a.cwiseMax(b);
  const bool is_small = lo.allFinite() && (hi - lo).maxCoeff() < kWidest_px &&
                        lo.cwiseAbs().maxCoeff() < kFarthest_px;
  if (!is_small) return;
  const int u0 = std::max(0, static_cast<int>(std::ceil(lo.x())));
  const int v0 = std::max(0, static_cast<int>(std::ceil(lo.y())));
  const int u1 = std::min(out.width, static_cast<int>(std::ceil(hi.x())));
  const int v1 = std::min(out.height, static_cast<int>(std::ceil(hi.y())));
  for (int v = v0; v < v1; ++v) {
    for (int u = u0; u < u1; ++u) {
      float& there = out.At(u, v);
      if (there == 0 || depth_m < there) there = depth_m;
    }
  }
}

}  // namespace

RgbImage Rectify(const RgbImage& image, const CameraModel& camera) {
  return RectifyImage(image, camera);
}

DepthImage Rectify(const DepthImage& depth_m, const CameraModel& camera) {
  return RectifyImage(depth_m, camera);
}

DepthImage RegisterDepth(const DepthImage& depth_m, const CameraIntrinsics& depth,
                         const CameraIntrinsics& colour, const Pose& T_colour_depth) {
  if (depth == colour && T_colour_depth.isApprox(Pose::Identity(), 1e-9)) return depth_m;
  DepthImage out(colour.width_px, colour.height_px);
  for (int v = 0; v < depth_m.height; ++v) {
    for (int u = 0; u < depth_m.width; ++u) {
      const double d = depth_m.At(u, v);
      if (!(d >= kNearest_m) || !std::isfinite(d)) continue;
      const double z = (T_colour_depth * BackProjectPixel(depth, u, v, d)).z();
      const Vector3d p0 = T_colour_depth * BackProjectPixel(depth, u - 0.5, v - 0.5, d);
      const Vector3d p1 = T_colour_depth * BackProjectPixel(depth, u + 0.5, v + 0.5, d);
      if (std::min({z, p0.z(), p1.z()}) < kNearest_m) continue;
      Put(out, Project(colour, p0), Project(colour, p1), static_cast<float>(z));
    }
  }
  return out;
}

}  // namespace crossnav::recordings
