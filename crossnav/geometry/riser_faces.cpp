// SPDX-License-Identifier: MIT
#include "crossnav/geometry/riser_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::geometry {
namespace {

constexpr double kUpright = 0.42;         // chosen: cosine to the vertical, 25 degrees
constexpr double kOneFace = 0.85;         // chosen: cosine between normals of one face
constexpr double kPlane_m = 0.02;         // chosen: noise about a face
constexpr double kRiserStep_m = 0.05;     // chosen: neighbours farther apart lie on two things
constexpr double kRiserEdgeShare = 0.02;  // chosen: stray points beyond an edge
constexpr std::size_t kLeastSeed = 40;    // chosen: pixels, of a face of 4 by 10
constexpr double kLowFace_m = 0.05, kHighFace_m = 0.26;  // chosen: range of built stairs
constexpr double kLeastWidth_m = 0.25;                   // chosen: of a foot and its place
constexpr double kLeastVertical = 0.5;  // chosen: share of a face's rectangle that is seen

bool IsUpright(const DepthSurface& s, int i) {
  return s.area_m2[i] > 0 && std::abs(s.normal_world[i].z()) < kUpright;
}

/// Upright pixels connected with pixel `first` without a bend.
std::vector<int> TakeFace(const DepthSurface& s, int first, std::vector<bool>& is_taken) {
  std::vector<int> pixels = {first};
  is_taken[first] = true;
  for (std::size_t next = 0; next < pixels.size(); ++next) {
    const int at = pixels[next], u = at % s.width, v = at / s.width;
    const std::array<int, 4> beside = {u > 0 ? at - 1 : at, u + 1 < s.width ? at + 1 : at,
                                       v > 0 ? at - s.width : at,
                                       v + 1 < s.height ? at + s.width : at};
    for (const int other : beside) {
      if (is_taken[other] || !IsUpright(s, other)) continue;
      const Vector3d step = s.p_world[other] - s.p_world[at];
      const bool has_bend = s.normal_world[at].dot(s.normal_world[other]) < kOneFace;
      if (has_bend || step.norm() > kRiserStep_m ||
          std::abs(step.dot(s.normal_world[at])) > kPlane_m)
        continue;
      is_taken[other] = true;
      pixels.push_back(other);
    }
  }
  return pixels;
}

double QuantileOf(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Normal and front of a face from the pixels whose normals are known.
void FitPlane(const DepthSurface& s, const std::vector<int>& pixels, RiserFace* face) {
  Vector3d sum = Vector3d::Zero();
  for (const int i : pixels) sum += s.area_m2[i] * s.normal_world[i];
  sum.z() = 0;
  face->normal_world = sum.normalized();
  std::vector<double> along_m;
  along_m.reserve(pixels.size());
  for (const int i : pixels) along_m.push_back(-face->normal_world.dot(s.p_world[i]));
  face->front_m = QuantileOf(along_m, 0.5);
}

/// The seed, and neighbours in its plane: normals at an edge mix both sides.
std::vector<int> WithEdges(const DepthSurface& s, const std::vector<int>& seed,
                           const RiserFace& face) {
  std::vector<int> pixels = seed;
  std::vector<bool> is_in_face(s.area_m2.size(), false);
  for (const int pixel : seed) is_in_face[pixel] = true;
  for (const int pixel : seed)
    for (int off = -s.reach_px; off <= s.reach_px; ++off)
      for (const auto& [u, v] : {std::pair(pixel % s.width + off, pixel / s.width),
                                 std::pair(pixel % s.width, pixel / s.width + off)}) {
        if (u < 0 || v < 0 || u >= s.width || v >= s.height || is_in_face[s.At(u, v)]) continue;
        const int other = s.At(u, v);
        const double along_m = -face.normal_world.dot(s.p_world[other]);
        if (!s.is_measured[other] || std::abs(along_m - face.front_m) > kPlane_m) continue;
        is_in_face[other] = true;
        pixels.push_back(other);
      }
  return pixels;
}

/// Edges of a face, and whether it is a whole rectangle rather than a ragged thing.
bool Measure(const DepthSurface& s, RiserFace* face) {
  const Vector3d aside = face->normal_world.cross(Vector3d::UnitZ());
  std::vector<double> height_m, aside_m;
  double area_m2 = 0;
  for (const int i : face->pixels) {
    height_m.push_back(s.p_world[i].z());
    aside_m.push_back(s.p_world[i].dot(aside));
    area_m2 += s.area_m2[i];
  }
  face->low_m = QuantileOf(height_m, kRiserEdgeShare);
  face->high_m = QuantileOf(height_m, 1 - kRiserEdgeShare);
  face->left_m = QuantileOf(aside_m, kRiserEdgeShare);
  face->right_m = QuantileOf(aside_m, 1 - kRiserEdgeShare);
  const double high_m = face->high_m - face->low_m, wide_m = face->right_m - face->left_m;
  return high_m >= kLowFace_m && high_m <= kHighFace_m && wide_m >= kLeastWidth_m &&
         area_m2 >= kLeastVertical * high_m * wide_m;
}

}  // namespace

std::vector<RiserFace> FindRiserFaces(const DepthSurface& s) {
  std::vector<RiserFace> faces;
  std::vector<bool> is_taken(s.area_m2.size(), false);
  for (int i = 0; i < static_cast<int>(s.area_m2.size()); ++i) {
    if (is_taken[i] || !IsUpright(s, i)) continue;
    const std::vector<int> seed = TakeFace(s, i, is_taken);
    if (seed.size() < kLeastSeed) continue;
    RiserFace face;
    FitPlane(s, seed, &face);
    face.pixels = WithEdges(s, seed, face);
    if (Measure(s, &face)) faces.push_back(std::move(face));
  }
  std::sort(faces.begin(), faces.end(),
            [](const RiserFace& a, const RiserFace& b) { return a.low_m < b.low_m; });
  return faces;
}

}  // namespace crossnav::geometry
