// SPDX-License-Identifier: MIT
#include "crossnav/geometry/treads.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::geometry {
namespace {

constexpr float kNearest_m = 0.2F, kFarthest_m = 5.0F;  // chosen: beyond, risers are noise
constexpr double kLevel = 0.94;         // chosen: cosine, 20 degrees: noise and a tilted camera
constexpr double kStep_m = 0.15;        // chosen: neighbours farther apart lie on two things
constexpr double kSmooth_m = 0.01;      // chosen: between neighbours of one tread
constexpr double kLeastArea_m2 = 0.02;  // chosen: a foot is 0.02 m2
constexpr double kSameHeight_m = 0.03;  // chosen: parts of one tread
constexpr double kLowRiser_m = 0.07, kHighRiser_m = 0.25;    // chosen: range of built stairs
constexpr double kShortTread_m = 0.15, kLongTread_m = 0.50;  // chosen: likewise
constexpr double kRiserSpread_m = 0.04;                      // chosen: risers of one flight
constexpr double kTreadSpread_m = 0.15;  // chosen: centres move where parts are hidden
constexpr double kStraight = 0.8;        // chosen: cosine between steps
constexpr double kGroundShare = 2.0;     // chosen: ground is larger than two treads
constexpr std::size_t kLeastLevels = 3;  // chosen: two equal risers

/// Points of the picture, and how much level surface each stands for (0 = not level).
struct Surface {
  int width = 0, height = 0;
  std::vector<Vector3d> p_world;
  std::vector<double> area_m2;
};

bool IsMeasured(float depth_m) {
  return depth_m >= kNearest_m && depth_m <= kFarthest_m;
}

Surface SurfaceOf(const DepthImage& depth_m, const CameraIntrinsics& camera,
                  const Pose& T_world_camera, const MaskImage& mask) {
  Surface s{depth_m.width, depth_m.height, {}, {}};
  s.p_world.resize(depth_m.data.size());
  s.area_m2.assign(depth_m.data.size(), 0);
  for (int v = 0; v < s.height; ++v)
    for (int u = 0; u < s.width; ++u)
      s.p_world[v * s.width + u] =
          T_world_camera * BackProjectPixel(camera, u, v, depth_m.At(u, v));
  const int reach = std::max(1, s.width / 128);
  for (int v = reach; v < s.height - reach; ++v)
    for (int u = reach; u < s.width - reach; ++u) {
      const std::array<int, 4> around = {v * s.width + u + reach, v * s.width + u - reach,
                                         (v + reach) * s.width + u, (v - reach) * s.width + u};
      const bool is_known = IsMeasured(depth_m.At(u, v)) && (mask.empty() || mask.At(u, v)) &&
                            std::all_of(around.begin(), around.end(),
                                        [&](int i) { return IsMeasured(depth_m.data[i]); });
      if (!is_known) continue;
      const Vector3d a = s.p_world[around[0]] - s.p_world[around[1]];
      const Vector3d b = s.p_world[around[2]] - s.p_world[around[3]];
      if (a.norm() > kStep_m || b.norm() > kStep_m) continue;
      const Vector3d n = a.cross(b);
      if (std::abs(n.z()) < kLevel * n.norm()) continue;
      s.area_m2[v * s.width + u] = n.norm() / (4.0 * reach * reach);
    }
  return s;
}

/// A connected level patch.
struct Patch {
  std::vector<int> pixels;
  Tread tread;
};

Patch TakePatch(const Surface& s, int seed, std::vector<bool>& is_taken) {
  Patch patch;
  patch.pixels = {seed};
  is_taken[seed] = true;
  for (std::size_t next = 0; next < patch.pixels.size(); ++next) {
    const int at = patch.pixels[next], u = at % s.width, v = at / s.width;
    const std::array<int, 4> beside = {u > 0 ? at - 1 : at, u + 1 < s.width ? at + 1 : at,
                                       v > 0 ? at - s.width : at,
                                       v + 1 < s.height ? at + s.width : at};
    for (const int other : beside) {
      if (is_taken[other] || s.area_m2[other] <= 0) continue;
      if (std::abs(s.p_world[other].z() - s.p_world[at].z()) > kSmooth_m) continue;
      is_taken[other] = true;
      patch.pixels.push_back(other);
    }
  }
  return patch;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void Describe(const Surface& s, Patch& patch) {
  std::vector<double> heights_m;
  patch.tread = {};
  for (const int i : patch.pixels) {
    heights_m.push_back(s.p_world[i].z());
    patch.tread.area_m2 += s.area_m2[i];
    patch.tread.p_center_world += s.p_world[i] / static_cast<double>(patch.pixels.size());
  }
  patch.tread.height_m = MedianOf(std::move(heights_m));
}

/// By height; parts of one height less than a long tread's two lengths apart are one.
std::vector<Patch> PatchesOf(const Surface& s) {
  std::vector<Patch> patches;
  std::vector<bool> is_taken(s.area_m2.size(), false);
  for (int i = 0; i < static_cast<int>(s.area_m2.size()); ++i) {
    if (is_taken[i] || s.area_m2[i] <= 0) continue;
    Patch patch = TakePatch(s, i, is_taken);
    Describe(s, patch);
    if (patch.tread.area_m2 < kLeastArea_m2) continue;
    const auto same = std::find_if(patches.begin(), patches.end(), [&](const Patch& other) {
      const Vector3d d = other.tread.p_center_world - patch.tread.p_center_world;
      return std::abs(other.tread.height_m - patch.tread.height_m) < kSameHeight_m &&
             d.norm() < 2 * kLongTread_m;
    });
    if (same == patches.end()) {
      patches.push_back(std::move(patch));
      continue;
    }
    same->pixels.insert(same->pixels.end(), patch.pixels.begin(), patch.pixels.end());
    Describe(s, *same);
  }
  std::sort(patches.begin(), patches.end(),
            [](const Patch& a, const Patch& b) { return a.tread.height_m < b.tread.height_m; });
  return patches;
}

Vector3d LevelStep(const Patch& from, const Patch& to) {
  Vector3d step = to.tread.p_center_world - from.tread.p_center_world;
  step.z() = 0;
  return step;
}

bool IsStep(const Patch& from, const Patch& to) {
  const double riser_m = to.tread.height_m - from.tread.height_m;
  const double tread_m = LevelStep(from, to).norm();
  return riser_m >= kLowRiser_m && riser_m <= kHighRiser_m && tread_m >= kShortTread_m &&
         tread_m <= kLongTread_m;
}

bool GoesOn(const Patch& a, const Patch& b, const Patch& c) {
  const Vector3d first = LevelStep(a, b), second = LevelStep(b, c);
  const double risers_m =
      (b.tread.height_m - a.tread.height_m) - (c.tread.height_m - b.tread.height_m);
  return std::abs(risers_m) <= kRiserSpread_m &&
         std::abs(first.norm() - second.norm()) <= kTreadSpread_m &&
         first.dot(second) >= kStraight * first.norm() * second.norm();
}

/// The longest chain of treads; of equal ones the first.
std::vector<std::size_t> LongestChain(const std::vector<Patch>& patches) {
  std::vector<std::size_t> best;
  for (std::size_t a = 0; a < patches.size(); ++a)
    for (std::size_t b = a + 1; b < patches.size(); ++b) {
      if (!IsStep(patches[a], patches[b])) continue;
      std::vector<std::size_t> chain = {a, b};
      for (std::size_t c = b + 1; c < patches.size(); ++c) {
        const Patch &last = patches[chain.back()], &before = patches[chain[chain.size() - 2]];
        if (IsStep(last, patches[c]) && GoesOn(before, last, patches[c])) chain.push_back(c);
      }
      if (chain.size() > best.size()) best = std::move(chain);
    }
  return best;
}

/// Whether the level before the flight is among `patches`: a riser below its lowest tread.
bool HasGroundBelow(const std::vector<Patch>& patches, const Patch& lowest, double riser_m) {
  return std::any_of(patches.begin(), patches.end(), [&](const Patch& patch) {
    const double below_m = lowest.tread.height_m - patch.tread.height_m;
    return std::abs(below_m - riser_m) <= kRiserSpread_m &&
           patch.tread.area_m2 > lowest.tread.area_m2;
  });
}

double FrontOf(const Surface& s, const Patch& patch, const Vector3d& direction) {
  std::vector<double> along_m;
  for (const int i : patch.pixels) along_m.push_back(s.p_world[i].dot(direction));
  const auto at = along_m.begin() + static_cast<std::ptrdiff_t>(along_m.size() / 20);
  std::nth_element(along_m.begin(), at, along_m.end());
  return *at;
}

}  // namespace

TreadFlight FindTreads(const DepthImage& depth_m, const CameraIntrinsics& camera,
                       const Pose& T_world_camera, const MaskImage& mask) {
  const Surface s = SurfaceOf(depth_m, camera, T_world_camera, mask);
  const std::vector<Patch> patches = PatchesOf(s);
  std::vector<std::size_t> chain = LongestChain(patches);
  TreadFlight flight;
  if (chain.size() < 2) return flight;
  std::vector<double> risers_m, treads_m;
  for (std::size_t k = 1; k < chain.size(); ++k)
    risers_m.push_back(patches[chain[k]].tread.height_m - patches[chain[k - 1]].tread.height_m);
  const double riser_m = MedianOf(risers_m);
  const Patch& first = patches[chain.front()];
  const bool has_ground = first.tread.area_m2 > kGroundShare * patches[chain[1]].tread.area_m2;
  const bool is_on_ground = !has_ground && HasGroundBelow(patches, first, riser_m);
  if (chain.size() + (is_on_ground ? 1 : 0) < kLeastLevels) return flight;
  if (has_ground) chain.erase(chain.begin());
  flight.direction_world = LevelStep(patches[chain.front()], patches[chain.back()]).normalized();
  for (const std::size_t k : chain) {
    flight.treads.push_back(patches[k].tread);
    flight.treads.back().front_m = FrontOf(s, patches[k], flight.direction_world);
  }
  for (std::size_t k = 1; k < flight.treads.size(); ++k)
    treads_m.push_back(flight.treads[k].front_m - flight.treads[k - 1].front_m);
  flight.riser_m = riser_m;
  flight.tread_m = MedianOf(std::move(treads_m));
  return flight;
}

}  // namespace crossnav::geometry
