// SPDX-License-Identifier: MIT
#include "crossnav/geometry/level_patches.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::geometry {
namespace {

constexpr double kLevel = 0.94;         // chosen: cosine, 20 degrees: noise and a tilted camera
constexpr double kSmooth_m = 0.01;      // chosen: between neighbours of one tread
constexpr double kLeastArea_m2 = 0.02;  // chosen: a foot is 0.02 m2
constexpr double kSamePatch_m = 0.03;   // chosen: parts of one tread
constexpr double kApart_m = 1.0;        // chosen: two lengths of a long tread

bool IsLevel(const DepthSurface& s, int i) {
  return s.area_m2[i] > 0 && std::abs(s.normal_world[i].z()) >= kLevel;
}

LevelPatch TakePatch(const DepthSurface& s, int seed, std::vector<bool>& is_taken) {
  LevelPatch patch;
  patch.pixels = {seed};
  is_taken[seed] = true;
  for (std::size_t next = 0; next < patch.pixels.size(); ++next) {
    const int at = patch.pixels[next], u = at % s.width, v = at / s.width;
    const std::array<int, 4> beside = {u > 0 ? at - 1 : at, u + 1 < s.width ? at + 1 : at,
                                       v > 0 ? at - s.width : at,
                                       v + 1 < s.height ? at + s.width : at};
    for (const int other : beside) {
      if (is_taken[other] || !IsLevel(s, other)) continue;
      if (std::abs(s.p_world[other].z() - s.p_world[at].z()) > kSmooth_m) continue;
      is_taken[other] = true;
      patch.pixels.push_back(other);
    }
  }
  return patch;
}

double MedianHeight(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void Describe(const DepthSurface& s, LevelPatch& patch) {
  std::vector<double> heights_m;
  patch.area_m2 = 0;
  patch.p_center_world = Vector3d::Zero();
  for (const int i : patch.pixels) {
    heights_m.push_back(s.p_world[i].z());
    patch.area_m2 += s.area_m2[i];
    patch.p_center_world += s.p_world[i] / static_cast<double>(patch.pixels.size());
  }
  patch.height_m = MedianHeight(std::move(heights_m));
}

}  // namespace

std::vector<LevelPatch> LevelPatchesOf(const DepthSurface& s) {
  std::vector<LevelPatch> patches;
  std::vector<bool> is_taken(s.area_m2.size(), false);
  for (int i = 0; i < static_cast<int>(s.area_m2.size()); ++i) {
    if (is_taken[i] || !IsLevel(s, i)) continue;
    LevelPatch patch = TakePatch(s, i, is_taken);
    Describe(s, patch);
    if (patch.area_m2 < kLeastArea_m2) continue;
    const auto same = std::find_if(patches.begin(), patches.end(), [&](const LevelPatch& other) {
      const Vector3d d = other.p_center_world - patch.p_center_world;
      return std::abs(other.height_m - patch.height_m) < kSamePatch_m && d.norm() < kApart_m;
    });
    if (same == patches.end()) {
      patches.push_back(std::move(patch));
      continue;
    }
    same->pixels.insert(same->pixels.end(), patch.pixels.begin(), patch.pixels.end());
    Describe(s, *same);
  }
  std::sort(patches.begin(), patches.end(),
            [](const LevelPatch& a, const LevelPatch& b) { return a.height_m < b.height_m; });
  return patches;
}

}  // namespace crossnav::geometry
