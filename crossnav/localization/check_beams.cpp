// SPDX-License-Identifier: MIT
#include <cmath>

#include "crossnav/localization/pose_search.h"

namespace crossnav::localization {
namespace {

constexpr std::uint8_t kAtSurface = 60;  // chosen: within a voxel and a half of a surface
constexpr double kMargin_m = 0.3;     // chosen: unchecked before the end, where the surface begins
constexpr double kMarginShare = 0.1;  // chosen: of the beam's length, for grazing surfaces

constexpr double kUnknownShare = 0.5;  // chosen: weight of a beam without a verdict

/// Samples in steps of half a voxel: a surface before the beam's end blocks it.
bool IsBlocked(const DenseMap& map, const Vector3d& eye_map, const Vector3d& end_map) {
  const Vector3d along = end_map - eye_map;
  const double length_m = along.norm(), margin_m = kMargin_m + kMarginShare * length_m;
  const double step_m = map.voxel_m / 2;
  int inside = 0;
  for (double s = 0.2; s < length_m - margin_m; s += step_m) {
    const Vector3d p = eye_map + along * (s / length_m);
    const bool is_surface = map.ContentAt(geometry::KeyOf(p, map.voxel_m)) == Content::kSurface;
    inside = is_surface ? inside + 1 : 0;
    if (inside >= 2) return true;  // one sample may be the corner of a voxel
  }
  return false;
}

Verdict Judge(const DenseMap& map, const Vector3d& eye_map, const Vector3d& end_map) {
  const std::int64_t index = map.IndexOf(geometry::KeyOf(end_map, map.voxel_m));
  if (IsBlocked(map, eye_map, end_map)) return Verdict::kContradicts;
  if (index < 0) return Verdict::kNothing;
  if (map.score[static_cast<std::size_t>(index)] >= kAtSurface) return Verdict::kAgrees;
  const bool is_unknown = map.content[static_cast<std::size_t>(index)] == Content::kUnknown;
  return is_unknown ? Verdict::kNothing : Verdict::kContradicts;
}

}  // namespace

void CheckBeams(const DenseMap& map, const std::vector<Beam>& beams, Hypothesis& hypothesis) {
  double agreeing = 0;
  const Eigen::Isometry3f T = hypothesis.T_map_odom.cast<float>();
  hypothesis.verdicts.clear();
  for (const Beam& beam : beams) {
    const Verdict verdict =
        Judge(map, (T * beam.p_eye_odom).cast<double>(), (T * beam.p_end_odom).cast<double>());
    hypothesis.verdicts.push_back(verdict);
    if (verdict == Verdict::kAgrees) agreeing += 1;
    if (verdict == Verdict::kNothing) agreeing += kUnknownShare;
  }
  hypothesis.agreement = beams.empty() ? 0 : agreeing / static_cast<double>(beams.size());
}

}  // namespace crossnav::localization
