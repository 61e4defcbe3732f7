// SPDX-License-Identifier: MIT
// NoisyDepth: each kind of noise is a pass over the pixels with its own random stream.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "crossnav/sim/sensing/sensor_noise.h"

namespace crossnav::sim {
namespace {

// chosen: side of a patch without depth, like shiny and dark objects [px of 640]
constexpr int kPatch_px = 16;
// chosen: neighbours whose depths differ by this share are on both sides of an edge
constexpr double kEdgeShare = 0.05;
constexpr double kFullAngle_rad = 1.48;  // chosen: 85 degrees; Nguyen's law has a pole at 90
constexpr float kGrazing = 0.5F;         // chosen: cosine of 60 degrees; no loss up to there
constexpr double kDark = 255.0 / 8;      // chosen: brighter surfaces return enough light
constexpr std::array<std::string_view, 3> kGlass = {"window", "glass", "mirror"};
constexpr std::array<std::string_view, 5> kOpaque = {"curtain", "frame", "blind", "sill", "seat"};

enum DepthStream : std::uint64_t {
  kShifts = 1,
  kEdges,
  kPatches,
  kReadings,
  kFlying,
  kDim,
  kPanes
};

/// Standard normal numbers, two from one number of 32 bits: the quantiles in the middle of 4,096
/// equal shares, which end at 3.7.
class QuickNormals {
 public:
  std::pair<float, float> Next(Rng& rng) const {
    const std::uint32_t bits = rng.Next();
    return {quantiles_[bits >> 20], quantiles_[bits & 4095]};
  }

 private:
  static float Quantile(double share) {
    double x = 0;
    for (int i = 0; i < 60; ++i) {  // bounded steps of Newton's method: the tails are flat
      const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * M_PI);
      const double error = 0.5 * std::erfc(-x / M_SQRT2) - share;
      x -= std::clamp(error / density, -0.5, 0.5);
    }
    return static_cast<float>(x);
  }
  static std::array<float, 4096> All() {
    std::array<float, 4096> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = Quantile((i + 0.5) / 4096);
    return all;
  }
  const std::array<float, 4096> quantiles_ = All();
};
const QuickNormals& Normals() {
  static const QuickNormals normals;
  return normals;
}

template <class F>
void ForEachPixel(const DepthImage& depth_m, F&& visit) {
  for (int v = 0; v < depth_m.height; ++v)
    for (int u = 0; u < depth_m.width; ++u) visit(u, v);
}

DepthImage Shifted(const DepthImage& depth_m, double sigma_px, Rng rng) {
  DepthImage shifted = depth_m;
  const auto rounded = [](double x) { return static_cast<int>(std::floor(x + 0.5)); };
  const QuickNormals& normals = Normals();
  ForEachPixel(depth_m, [&](int u, int v) {
    const auto [right, down] = normals.Next(rng);
    const int from_u = u + rounded(sigma_px * right), from_v = v + rounded(sigma_px * down);
    shifted.At(u, v) = depth_m.At(std::clamp(from_u, 0, depth_m.width - 1),
                                  std::clamp(from_v, 0, depth_m.height - 1));
  });
  return shifted;
}

/// Depth on the other side where the perfect picture jumps between this pixel and one of its four
/// neighbours, else 0.
float BeyondEdge(const DepthImage& depth_m, int u, int v) {
  const float here = depth_m.At(u, v);
  for (const auto& [nu, nv] :
       {std::pair(u - 1, v), std::pair(u + 1, v), std::pair(u, v - 1), std::pair(u, v + 1)}) {
    if (!depth_m.Contains(nu, nv)) continue;
    const float there = depth_m.At(nu, nv);
    if (std::abs(there - here) > kEdgeShare * std::min(there, here)) return std::max(there, 1e-6F);
  }
  return 0;
}

/// BeyondEdge of all pixels.
DepthImage EdgesOf(const DepthImage& depth_m) {
  DepthImage edges_m = depth_m;
  ForEachPixel(depth_m, [&](int u, int v) { edges_m.At(u, v) = BeyondEdge(depth_m, u, v); });
  return edges_m;
}

/// Flying pixels: light from both sides of an edge reaches one pixel, and the sensor reads a depth
/// between.
void MixEdges(const DepthImage& edges_m, double probability, Rng rng, DepthImage& depth_m) {
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    const float there = edges_m.data[i];
    if (there <= 0 || !rng.Chance(probability)) continue;
    const auto share = static_cast<float>(rng.Uniform());
    if (depth_m.data[i] > 0) depth_m.data[i] += share * (there - depth_m.data[i]);
  }
}

void LoseEdges(const DepthImage& edges_m, double probability, Rng rng, DepthImage& depth_m) {
  for (std::size_t i = 0; i < depth_m.data.size(); ++i)
    if (edges_m.data[i] > 0 && rng.Chance(probability)) depth_m.data[i] = 0;
}

void LosePatches(double share, Rng rng, DepthImage& depth_m) {
  for (int v0 = 0; v0 < depth_m.height; v0 += kPatch_px) {
    for (int u0 = 0; u0 < depth_m.width; u0 += kPatch_px) {
      if (!rng.Chance(share)) continue;
      for (int v = v0; v < std::min(v0 + kPatch_px, depth_m.height); ++v) {
        const auto row = depth_m.data.begin() + static_cast<std::ptrdiff_t>(v) * depth_m.width;
        std::fill(row + u0, row + std::min(u0 + kPatch_px, depth_m.width), 0.0F);
      }
    }
  }
}

/// Cosine of the angle between each pixel's ray and the surface's normal; 1 beside jumps and
/// borders.
std::vector<float> CosinesOf(const DepthImage& depth_m, const DepthImage& edges_m,
                             const CameraIntrinsics& camera) {
  std::vector<float> cosines(depth_m.data.size(), 1.0F);
  ForEachPixel(depth_m, [&](int u, int v) {
    if (u == 0 || v == 0 || u + 1 >= depth_m.width || v + 1 >= depth_m.height) return;
    if (!(depth_m.At(u, v) > 0) || edges_m.At(u, v) > 0) return;
    const auto at = [&](int nu, int nv) {
      return BackProjectPixel(camera, nu, nv, depth_m.At(nu, nv));
    };
    const Vector3d n = (at(u + 1, v) - at(u - 1, v)).cross(at(u, v + 1) - at(u, v - 1));
    const Vector3d p = at(u, v);
    const double cosine =
        std::abs(n.dot(p)) / std::max(1e-12, std::sqrt(n.squaredNorm() * p.squaredNorm()));
    cosines[static_cast<std::size_t>(v) * depth_m.width + u] =
        std::min(1.0F, static_cast<float>(cosine));
  });
  return cosines;
}

/// Loses pixels with too little returned light: dark surfaces, and grazing angles.
void LoseDim(const NoiseConfig& noise, const Scenery& scenery, const std::vector<float>& cosines,
             Rng rng, DepthImage& depth_m) {
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    double keep = 1;
    if (!cosines.empty() && cosines[i] < kGrazing)
      keep *= 1 - noise.depth_grazing_hole * (std::acos(cosines[i]) - std::acos(kGrazing)) /
                      (M_PI_2 - std::acos(kGrazing));
    if (scenery.rgb != nullptr && scenery.rgb->data.size() == depth_m.data.size()) {
      const Rgb8& c = scenery.rgb->data[i];
      const double light = 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
      keep *= 1 - noise.depth_dark_hole * std::max(0.0, 1 - light / kDark);
    }
    if (rng.Uniform() >= keep) depth_m.data[i] = 0;
  }
}

void LoseGlass(double probability, const Scenery& scenery, Rng rng, DepthImage& depth_m) {
  if (scenery.instance == nullptr || scenery.glass == nullptr) return;
  if (scenery.instance->data.size() != depth_m.data.size()) return;
  for (std::size_t i = 0; i < depth_m.data.size(); ++i)
    if (scenery.glass->count(scenery.instance->data[i]) > 0 && rng.Chance(probability))
      depth_m.data[i] = 0;
}

/// Nguyen et al. 2012, eq. 3: how the term of sigma that depends on the angle grows, by the cosine
/// of the angle, at 1,024 values.
class AngleTerm {
 public:
  double At(float cosine) const { return terms_[static_cast<std::size_t>(cosine * 1023)]; }

 private:
  static std::array<double, 1024> All() {
    std::array<double, 1024> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double a = std::min(std::acos(std::min(1.0, (i + 0.5) / 1023)), kFullAngle_rad);
      all[i] = std::pow(a / (M_PI_2 - a), 2);
    }
    return all;
  }
  const std::array<double, 1024> terms_ = All();
};
double AngleSigma(const NoiseConfig& noise, double z_m, float cosine) {
  static const AngleTerm term;
  return noise.depth_angle_sigma_m * term.At(cosine) / std::sqrt(z_m);
}

/// `normal`: standard normal of this pixel.
float Reading(const NoiseConfig& noise, double z_m, double sigma_m, double normal) {
  double read_m = z_m + sigma_m * normal;
  if (read_m <= 0) return 0;
  const double step_m = noise.depth_step_per_m2 * z_m * z_m;
  if (step_m > 0) read_m = std::round(read_m / step_m) * step_m;
  if (noise.depth_max_m > 0 && read_m > noise.depth_max_m) return 0;
  return static_cast<float>(read_m);
}

}  // namespace

bool IsGlass(std::string_view name) {
  const auto has = [&](std::string_view word) { return name.find(word) != name.npos; };
  return std::any_of(kGlass.begin(), kGlass.end(), has) &&
         std::none_of(kOpaque.begin(), kOpaque.end(), has);
}

DepthImage NoisyDepth(const NoiseConfig& noise, const DepthImage& depth_m, std::uint64_t seed,
                      const Scenery& scenery) {
  DepthImage noisy = noise.depth_shift_px > 0
                         ? Shifted(depth_m, noise.depth_shift_px, Rng(seed, kShifts))
                         : depth_m;
  const bool has_angles = scenery.camera.width_px > 0 &&
                          (noise.depth_angle_sigma_m > 0 || noise.depth_grazing_hole > 0);
  const bool has_edges = has_angles || noise.depth_flying > 0 || noise.depth_edge_hole > 0;
  const DepthImage edges_m = has_edges ? EdgesOf(depth_m) : DepthImage{};
  if (noise.depth_flying > 0) MixEdges(edges_m, noise.depth_flying, Rng(seed, kFlying), noisy);
  if (noise.depth_edge_hole > 0)
    LoseEdges(edges_m, noise.depth_edge_hole, Rng(seed, kEdges), noisy);
  if (noise.depth_hole_share > 0) LosePatches(noise.depth_hole_share, Rng(seed, kPatches), noisy);
  const auto cosines =
      has_angles ? CosinesOf(depth_m, edges_m, scenery.camera) : std::vector<float>{};
  if (noise.depth_grazing_hole > 0 || noise.depth_dark_hole > 0)
    LoseDim(noise, scenery, cosines, Rng(seed, kDim), noisy);
  if (noise.depth_glass_hole > 0)
    LoseGlass(noise.depth_glass_hole, scenery, Rng(seed, kPanes), noisy);
  Rng rng(seed, kReadings);
  const QuickNormals& all = Normals();
  std::pair<float, float> normals;
  for (std::size_t i = 0; i < noisy.data.size(); ++i) {
    if (i % 2 == 0) normals = all.Next(rng);
    const double z_m = noisy.data[i];
    if (!(z_m > 0)) continue;
    const double more_m = cosines.empty() ? 0 : AngleSigma(noise, z_m, cosines[i]);
    noisy.data[i] = Reading(noise, z_m, DepthSigma(noise, z_m) + more_m,
                            i % 2 == 0 ? normals.first : normals.second);
  }
  return noisy;
}

}  // namespace crossnav::sim
