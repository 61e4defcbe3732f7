// SPDX-License-Identifier: MIT
#include "crossnav/geometry/treads.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "crossnav/geometry/depth_surface.h"
#include "crossnav/geometry/level_patches.h"
#include "crossnav/geometry/riser_faces.h"

namespace crossnav::geometry {
namespace {

constexpr double kLowRiser_m = 0.07, kHighRiser_m = 0.25;    // chosen: range of built stairs
constexpr double kShortTread_m = 0.15, kLongTread_m = 0.50;  // chosen: likewise
constexpr double kRiserSpread_m = 0.04;                      // chosen: risers of one flight
constexpr double kTreadSpread_m = 0.10;  // chosen: fronts move where parts are hidden
constexpr double kGroundShare = 2.0;     // chosen: ground is larger than two treads
constexpr double kSameHeight_m = 0.03;   // chosen: a tread and its riser's upper edge
constexpr double kSameFront_m = 0.12;    // chosen: likewise; a tread's front may be hidden
constexpr double kOverlap = 0.5;         // chosen: share of the narrower one of two treads
constexpr double kOneWay = 0.985;        // chosen: cosine, 10 degrees
constexpr double kEdgeShare = 0.05;      // chosen: stray points beyond an edge
constexpr std::size_t kLeastLevels = 3;  // chosen: two equal risers, the ground's included

/// A tread as one direction sees it: by its patch, by its riser's face, or by both.
struct Level {
  Tread tread;
  double left_m = 0, right_m = 0;
  bool has_face = false;
};

/// Surfaces of one picture, before a direction is chosen.
struct Evidence {
  DepthSurface surface;
  std::vector<LevelPatch> patches;
  std::vector<RiserFace> faces;
};

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Lower and upper end of the pixels along an axis.
std::pair<double, double> EndsOf(const DepthSurface& s, const std::vector<int>& pixels,
                                 const Vector3d& axis) {
  std::vector<double> along_m;
  along_m.reserve(pixels.size());
  for (const int i : pixels) along_m.push_back(s.p_world[i].dot(axis));
  const auto at = [&](double share) {
    const auto place = along_m.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(along_m.size() - 1));
    std::nth_element(along_m.begin(), place, along_m.end());
    return *place;
  };
  const double low_m = at(kEdgeShare);
  return {low_m, at(1 - kEdgeShare)};
}

Level LevelOfFace(const DepthSurface& s, const RiserFace& face, const Vector3d& direction) {
  Level level;
  level.has_face = true;
  for (const int i : face.pixels)
    level.tread.p_center_world += s.p_world[i] / static_cast<double>(face.pixels.size());
  level.tread.front_m = level.tread.p_center_world.dot(direction);
  level.tread.p_center_world.z() = level.tread.height_m = face.high_m;
  std::tie(level.left_m, level.right_m) =
      EndsOf(s, face.pixels, direction.cross(Vector3d::UnitZ()));
  return level;
}

Level LevelOfPatch(const DepthSurface& s, const LevelPatch& patch, const Vector3d& direction) {
  Level level;
  level.tread = {patch.height_m, EndsOf(s, patch.pixels, direction).first, patch.area_m2,
                 patch.p_center_world};
  std::tie(level.left_m, level.right_m) =
      EndsOf(s, patch.pixels, direction.cross(Vector3d::UnitZ()));
  return level;
}

double CommonOf(const Level& a, const Level& b) {
  const double narrow_m = std::min(a.right_m - a.left_m, b.right_m - b.left_m);
  const double common_m = std::min(a.right_m, b.right_m) - std::max(a.left_m, b.left_m);
  return narrow_m > 0 ? common_m / narrow_m : 0;
}

/// By height. A face and the patch above it are one: its front, the patch's height and area.
std::vector<Level> LevelsAlong(const Evidence& seen, const Vector3d& direction) {
  std::vector<Level> levels;
  for (const RiserFace& face : seen.faces)
    if (-face.normal_world.dot(direction) >= kOneWay)
      levels.push_back(LevelOfFace(seen.surface, face, direction));
  for (const LevelPatch& patch : seen.patches) {
    const Level above = LevelOfPatch(seen.surface, patch, direction);
    const auto below = std::find_if(levels.begin(), levels.end(), [&](const Level& level) {
      return level.has_face && level.tread.area_m2 == 0 &&
             std::abs(level.tread.height_m - patch.height_m) <= kSameHeight_m &&
             std::abs(level.tread.front_m - above.tread.front_m) <= kSameFront_m &&
             CommonOf(level, above) >= kOverlap;
    });
    if (below == levels.end()) {
      levels.push_back(above);
      continue;
    }
    const double front_m = below->tread.front_m;
    below->tread = above.tread;
    below->tread.front_m = front_m;
  }
  std::sort(levels.begin(), levels.end(),
            [](const Level& a, const Level& b) { return a.tread.height_m < b.tread.height_m; });
  return levels;
}

bool IsStep(const Level& from, const Level& to) {
  const double riser_m = to.tread.height_m - from.tread.height_m;
  const double tread_m = to.tread.front_m - from.tread.front_m;
  return riser_m >= kLowRiser_m && riser_m <= kHighRiser_m && tread_m >= kShortTread_m &&
         tread_m <= kLongTread_m && CommonOf(from, to) >= kOverlap;
}

bool GoesOn(const Level& a, const Level& b, const Level& c) {
  const auto riser_m = [](const Level& from, const Level& to) {
    return to.tread.height_m - from.tread.height_m;
  };
  const auto tread_m = [](const Level& from, const Level& to) {
    return to.tread.front_m - from.tread.front_m;
  };
  return std::abs(riser_m(a, b) - riser_m(b, c)) <= kRiserSpread_m &&
         std::abs(tread_m(a, b) - tread_m(b, c)) <= kTreadSpread_m;
}

/// The longest chain of treads; of equal ones the first.
std::vector<Level> LongestChain(const std::vector<Level>& levels) {
  std::vector<Level> best;
  for (std::size_t a = 0; a < levels.size(); ++a)
    for (std::size_t b = a + 1; b < levels.size(); ++b) {
      if (!IsStep(levels[a], levels[b])) continue;
      std::vector<Level> chain = {levels[a], levels[b]};
      for (std::size_t c = b + 1; c < levels.size(); ++c)
        if (IsStep(chain.back(), levels[c]) &&
            GoesOn(chain[chain.size() - 2], chain.back(), levels[c]))
          chain.push_back(levels[c]);
      if (chain.size() > best.size()) best = std::move(chain);
    }
  return best;
}

/// Whether the level before the flight is seen: a riser below its lowest tread, and larger.
bool HasGroundBelow(const Evidence& seen, const Tread& lowest, double riser_m) {
  return std::any_of(seen.patches.begin(), seen.patches.end(), [&](const LevelPatch& patch) {
    const double below_m = lowest.height_m - patch.height_m;
    return std::abs(below_m - riser_m) <= kRiserSpread_m && patch.area_m2 > lowest.area_m2;
  });
}

TreadFlight FlightAlong(const Evidence& seen, const Vector3d& direction) {
  std::vector<Level> chain = LongestChain(LevelsAlong(seen, direction));
  TreadFlight flight;
  if (chain.size() < 2) return flight;
  std::vector<double> risers_m, treads_m;
  for (std::size_t k = 1; k < chain.size(); ++k)
    risers_m.push_back(chain[k].tread.height_m - chain[k - 1].tread.height_m);
  const double riser_m = MedianOf(std::move(risers_m));
  const Level& first = chain.front();
  const bool has_ground = !first.has_face && chain[1].tread.area_m2 > 0 &&
                          first.tread.area_m2 > kGroundShare * chain[1].tread.area_m2;
  const bool is_on_ground = !has_ground && HasGroundBelow(seen, first.tread, riser_m);
  const bool has_patches = std::all_of(chain.begin(), chain.end(),
                                       [](const Level& level) { return level.tread.area_m2 > 0; });
  const bool is_stood_on = is_on_ground && has_patches;  // a box's face on a desk is no flight
  if (chain.size() + (is_stood_on ? 1 : 0) < kLeastLevels) return flight;
  if (has_ground) chain.erase(chain.begin());
  flight.direction_world = direction;
  flight.riser_m = riser_m;
  for (const Level& level : chain) {
    if (!flight.treads.empty())
      treads_m.push_back(level.tread.front_m - flight.treads.back().front_m);
    flight.treads.push_back(level.tread);
  }
  flight.tread_m = MedianOf(std::move(treads_m));
  return flight;
}

/// Ways that a flight may lead: against a face, or from one patch to another that is a step off.
std::vector<Vector3d> DirectionsOf(const Evidence& seen) {
  std::vector<Vector3d> directions;
  const auto add = [&](const Vector3d& direction) {
    const bool is_known = std::any_of(directions.begin(), directions.end(), [&](const Vector3d& d) {
      return d.dot(direction) >= kOneWay;
    });
    if (!is_known) directions.push_back(direction);
  };
  for (const RiserFace& face : seen.faces) add(-face.normal_world);
  for (std::size_t a = 0; a < seen.patches.size(); ++a)
    for (std::size_t b = a + 1; b < seen.patches.size(); ++b) {
      Vector3d step = seen.patches[b].p_center_world - seen.patches[a].p_center_world;
      const double riser_m = seen.patches[b].height_m - seen.patches[a].height_m;
      step.z() = 0;
      if (riser_m >= kLowRiser_m && riser_m <= kHighRiser_m && step.norm() >= kShortTread_m &&
          step.norm() <= kLongTread_m)
        add(step.normalized());
    }
  return directions;
}

}  // namespace

TreadFlight FindTreads(const DepthImage& depth_m, const CameraIntrinsics& camera,
                       const Pose& T_world_camera, const MaskImage& mask) {
  Evidence seen{SurfaceOf(depth_m, camera, T_world_camera, mask), {}, {}};
  const Eigen::Matrix3d R_level_world = LevelBy(T_world_camera, &seen.surface);
  seen.patches = LevelPatchesOf(seen.surface);
  seen.faces = FindRiserFaces(seen.surface);
  TreadFlight best;
  for (const Vector3d& direction : DirectionsOf(seen)) {
    TreadFlight flight = FlightAlong(seen, direction);
    if (flight.treads.size() > best.treads.size()) best = std::move(flight);
  }
  const Vector3d eye = T_world_camera.translation();
  const Eigen::Matrix3d R_world_level = R_level_world.transpose();
  best.direction_world = R_world_level * best.direction_world;
  for (Tread& tread : best.treads)
    tread.p_center_world = eye + R_world_level * (tread.p_center_world - eye);
  return best;
}

}  // namespace crossnav::geometry
