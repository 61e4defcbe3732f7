// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/picture.h"

#include <array>

#include <algorithm>
#include <cmath>

#include "crossnav/core/check.h"
#include "crossnav/core/png_image.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/write_file.h"

namespace crossnav::sim {
namespace {

constexpr double kCut_m = 2.0;    // chosen: over every chair back, under door lintels
constexpr double kBelow_m = 0.6;  // how far under the floor still belongs to it (sunken parts)
constexpr int kMaxSide_px = 4096;

Rgb8 Mix(const Rgb8& a, const Rgb8& b, double share_b) {
  const auto mix = [share_b](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + (y - x) * share_b));
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

}  // namespace

Result<void> WritePng(const RgbImage& image, const std::filesystem::path& file) {
  if (image.empty()) return Fail(ErrorCode::kInvalid, "an image without pixels cannot be a PNG");
  if (std::max(image.width, image.height) > kMostPngSide_px) {
    return Fail(ErrorCode::kInvalid, "too many pixels for a PNG", file.string());
  }
  return WriteFileAtomically(file, EncodePng(image));
}

RgbImage ColourDepth(const DepthImage& depth_m, double max_m) {
  // Five stops from near to far.
  constexpr std::array<Rgb8, 5> kStops{
      {{255, 245, 190}, {250, 170, 60}, {200, 60, 80}, {90, 30, 120}, {15, 15, 60}}};
  RgbImage out(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const double d = depth_m.data[i];
    if (!(d > 0) || !std::isfinite(d)) continue;
    const double at = std::clamp(d / max_m, 0.0, 1.0) * (kStops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
    out.data[i] = Mix(kStops[stop], kStops[stop + 1], at - static_cast<double>(stop));
  }
  return out;
}

RgbImage ColourInstances(const InstanceImage& instance) {
  RgbImage out(instance.width, instance.height);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const std::int32_t id = instance.data[i];
    if (id == 0) continue;
    const std::uint64_t h = MixSeed(static_cast<std::uint64_t>(id), 0x5eed);
    const auto channel = [h](int shift) {
      return static_cast<std::uint8_t>(64 + (h >> shift) % 192);
    };
    out.data[i] = {channel(0), channel(16), channel(32)};
  }
  return out;
}

TopDown RenderTopDown(const Scene& scene, const RayCaster& caster, const NavMesh& navmesh,
                      int floor, double px_per_m) {
  CROSSNAV_CHECK(floor >= 0 && floor < static_cast<int>(navmesh.Floors().size()), "no such floor");
  CROSSNAV_CHECK(px_per_m > 0, "px_per_m must be positive");
  const Floor& storey = navmesh.Floors()[static_cast<std::size_t>(floor)];
  const double ground = storey.height_m;
  const double lowest = storey.levels_m.empty() ? ground : storey.levels_m.front();
  const double under_m = ground - lowest + kBelow_m;
  Box3 box;
  for (const Vector3f& v : scene.mesh.vertices) {
    if (v.z() > ground - under_m && v.z() < ground + 3.0) box.Add(v.cast<double>());
  }
  for (const auto& t : navmesh.Triangles()) {
    for (const Vector3f& v : t.p_world) box.Add(v.cast<double>());
  }
  const double side_m = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y());
  TopDown out;
  out.px_per_m = std::min(px_per_m, kMaxSide_px / std::max(side_m, 1e-3));
  out.max_x_m = box.max.x();
  out.max_y_m = box.max.y();
  const auto pixels = [&out](double m) { return std::max(1, static_cast<int>(m * out.px_per_m)); };
  out.image = RgbImage(pixels(box.max.y() - box.min.y()), pixels(box.max.x() - box.min.x()),
                       Rgb8{245, 245, 245});
  for (int v = 0; v < out.image.height; ++v) {
    for (int u = 0; u < out.image.width; ++u) {
      const Vector3d eye(out.max_x_m - (v + 0.5) / out.px_per_m,
                         out.max_y_m - (u + 0.5) / out.px_per_m, ground + kCut_m);
      const auto hit = caster.Cast(eye, -Vector3d::UnitZ(), kCut_m + under_m + 3.0);
      if (!hit) continue;
      const double below_m = ground - hit->p_world.z();
      Rgb8 colour = hit->colour;
      if (below_m > under_m) colour = Mix(colour, {40, 40, 60}, 0.6);  // seen through a stairwell
      const auto heights =
          navmesh.HeightsAt(eye.x(), eye.y(), hit->p_world.z() - 0.2, hit->p_world.z() + 0.2);
      if (!heights.empty() && below_m <= under_m) colour = Mix(colour, kWalkableTint, 0.3);
      out.image.At(u, v) = colour;
    }
  }
  return out;
}

}  // namespace crossnav::sim
