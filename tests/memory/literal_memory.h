// SPDX-License-Identifier: MIT
// The formulas of the semantic memory, one pixel at a time in double: the oracle of these tests.
#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::memory::testing {

struct LiteralFactors {
  double gamma = 0.20, d0_m = 1.0, sigma_m = 1.5, gradient_scale = 1.0, epsilon = 1e-6;
};

inline bool IsValidDepth(float d) {
  return std::isfinite(d) && d > 0;
}

inline double LiteralDifference(const DepthImage& depth, int u, int v, int du, int dv) {
  const auto valid = [&](int a, int b) {
    return depth.Contains(a, b) && IsValidDepth(depth.At(a, b));
  };
  const bool before = valid(u - du, v - dv), after = valid(u + du, v + dv);
  const double center = depth.At(u, v);
  if (before && after)
    return (static_cast<double>(depth.At(u + du, v + dv)) - depth.At(u - du, v - dv)) / 2;
  if (after) return depth.At(u + du, v + dv) - center;
  if (before) return center - depth.At(u - du, v - dv);
  return 0;
}

inline double LiteralQuality(const DepthImage& depth, int u, int v, const LiteralFactors& f) {
  if (!IsValidDepth(depth.At(u, v))) return 0;
  const double gradient =
      std::hypot(LiteralDifference(depth, u, v, 1, 0), LiteralDifference(depth, u, v, 0, 1));
  const double off = f.d0_m - depth.At(u, v);
  return (1 - std::tanh(f.gamma * gradient * f.gradient_scale)) *
         std::exp(-off * off / (3 * f.sigma_m * f.sigma_m));
}

/// Half-pixel centres, edges clamped.
inline std::vector<double> LiteralBilinear(const FeatureGridView& grid, int u, int v, int width,
                                           int height) {
  const double y = std::min(std::max((v + 0.5) * grid.rows / height - 0.5, 0.0), grid.rows - 1.0);
  const double x = std::min(std::max((u + 0.5) * grid.cols / width - 0.5, 0.0), grid.cols - 1.0);
  const int y0 = static_cast<int>(y), x0 = static_cast<int>(x);
  const int y1 = std::min(y0 + 1, grid.rows - 1), x1 = std::min(x0 + 1, grid.cols - 1);
  const double fy = y - y0, fx = x - x0;
  std::vector<double> out(grid.dim);
  for (int i = 0; i < grid.dim; ++i) {
    const auto at = [&](int r, int c) {
      return static_cast<double>(
          grid.data[(static_cast<std::size_t>(r) * grid.cols + c) * grid.dim + i]);
    };
    out[i] = (1 - fy) * ((1 - fx) * at(y0, x0) + fx * at(y0, x1)) +
             fy * ((1 - fx) * at(y1, x0) + fx * at(y1, x1));
  }
  return out;
}

/// End voxels of all valid pixels, row by row, as the map reports them.
inline std::vector<PixelVoxel> EndVoxels(const DepthImage& depth, const CameraIntrinsics& camera,
                                         const Pose& T_world_camera, double voxel_m) {
  std::vector<PixelVoxel> out;
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      if (!IsValidDepth(depth.At(u, v))) continue;
      const Vector3d p_world = T_world_camera * BackProjectPixel(camera, u, v, depth.At(u, v));
      out.push_back({v * depth.width + u, geometry::KeyOf(p_world, voxel_m)});
    }
  return out;
}

class LiteralMemory {
 public:
  struct Entry {
    std::vector<double> feature;
    double weight = 0;
  };

  explicit LiteralMemory(const LiteralFactors& factors) : factors_(factors) {}

  void Fuse(const std::vector<PixelVoxel>& pixels, const DepthImage& depth,
            const FeatureGridView& grid) {
    std::map<VoxelKey, Entry> sums;
    for (const PixelVoxel& p : pixels) {
      const int u = p.pixel % depth.width, v = p.pixel / depth.width;
      const double q = LiteralQuality(depth, u, v, factors_);
      if (q <= 0) continue;
      Entry& sum = sums[p.key];
      sum.feature.resize(grid.dim);
      const std::vector<double> f = LiteralBilinear(grid, u, v, depth.width, depth.height);
      for (int i = 0; i < grid.dim; ++i) sum.feature[i] += q * f[i];
      sum.weight += q;
    }
    for (const auto& [key, sum] : sums) {
      Entry& entry = entries_[key];
      entry.feature.resize(grid.dim);
      for (int i = 0; i < grid.dim; ++i) {
        const double mean = sum.feature[i] / (sum.weight + factors_.epsilon);
        entry.feature[i] =
            (entry.weight * entry.feature[i] + sum.weight * mean) / (entry.weight + sum.weight);
      }
      entry.weight += sum.weight;
    }
  }

  const std::map<VoxelKey, Entry>& entries() const { return entries_; }

 private:
  LiteralFactors factors_;
  std::map<VoxelKey, Entry> entries_;
};

template <class A, class B>
double CosineOf(const A& a, const B& b) {
  double dot = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    dot += static_cast<double>(a[i]) * b[i];
    aa += static_cast<double>(a[i]) * a[i];
    bb += static_cast<double>(b[i]) * b[i];
  }
  return dot / std::sqrt(aa * bb);
}

/// Largest component of a - b against the largest component of b.
template <class A, class B>
double RelativeError(const A& a, const B& b) {
  double worst = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(static_cast<double>(a[i]) - b[i]));
    scale = std::max(scale, std::abs(static_cast<double>(b[i])));
  }
  return worst / std::max(scale, 1e-12);
}

}  // namespace crossnav::memory::testing
