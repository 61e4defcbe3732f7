// SPDX-License-Identifier: MIT
// Segments in gaps and the voxels they pass, against one gap at a time and WalkRay.
#include "crossnav/geometry/grazing_surface_simd.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/ray_walk.h"
#include "random_frames.h"

namespace crossnav::geometry {
namespace {

using testing::RandomFrame;
using testing::TestFrame;
using Ends = std::array<double, 6>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The pixels of one gap's line, 0 and 1 being its own.
struct Line {
  const DepthFrame& frame;
  int u, v;
  bool is_column;
  double voxel_m;

  double InverseAt(int i) const {
    const int at_u = u + (is_column ? 0 : i), at_v = v + (is_column ? i : 0);
    if (at_u < 0 || at_v < 0 || at_u >= frame.depth_m.width || at_v >= frame.depth_m.height)
      return kNone;
    const float z = frame.depth_m.At(at_u, at_v);
    return z > 0 && z < 1000 ? 1.0 / z : kNone;
  }
  Vector3d PointAt(double t, double inverse) const {
    return BackProjectToVoxels(frame.camera, frame.T_world_camera, u + (is_column ? 0 : t),
                               v + (is_column ? t : 0), 1 / inverse, voxel_m);
  }
};

bool IsSame(double step, double other) {
  return std::abs(step - other) <= 0.5 * std::abs(step);
}

Ends EndsOf(const Vector3d& a, const Vector3d& b) {
  return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
}

void Continue(const Line& line, int from, double depth_max_m, std::vector<Ends>* out) {
  const int away = from == 0 ? -1 : 1;
  const double here = line.InverseAt(from), next = line.InverseAt(from - away);
  const double before = line.InverseAt(from + away), before_that = line.InverseAt(from + 2 * away);
  const double step = here - before;
  if (!IsSame(step, before - before_that) || !(step < 0) || next < here + step) return;
  const double t = std::min(1.0, (1 / depth_max_m - here) / step);
  if (t > 0)
    out->push_back(
        EndsOf(line.PointAt(from, here), line.PointAt(from - away * t, here + step * t)));
}

std::vector<Ends> LiteralSegments(const DepthFrame& frame, const MapConfig& config,
                                  const Gaps& gaps) {
  std::vector<Ends> out;
  for (int i = 0; i < gaps.count; ++i) {
    const Line line{frame, gaps.u[i], gaps.v[i], gaps.is_column[i] != 0, config.voxel_m};
    const double first = line.InverseAt(0), second = line.InverseAt(1), here = second - first;
    const bool is_plane = gaps.is_wide[i] == 0 || IsSame(here, first - line.InverseAt(-1)) ||
                          IsSame(here, line.InverseAt(2) - second);
    if (is_plane && !std::isnan(here)) {
      out.push_back(EndsOf(line.PointAt(0, first), line.PointAt(1, second)));
      continue;
    }
    Continue(line, 0, config.depth_max_m, &out);
    Continue(line, 1, config.depth_max_m, &out);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Ends> Sorted(const Segments& segments) {
  std::vector<Ends> out;
  for (int i = 0; i < segments.count; ++i)
    out.push_back({segments.a[0][i], segments.a[1][i], segments.a[2][i], segments.b[0][i],
                   segments.b[1][i], segments.b[2][i]});
  std::sort(out.begin(), out.end());
  return out;
}

Gaps RandomGaps(Rng& rng, const DepthImage& depth_m) {
  Gaps gaps;
  const int count = rng.Int(0, Gaps::kRoom);
  while (gaps.count < count) {
    const bool is_column = rng.Chance(0.5);
    gaps.Add(rng.Int(0, depth_m.width - (is_column ? 1 : 2)),
             rng.Int(0, depth_m.height - (is_column ? 2 : 1)), is_column, rng.Chance(0.7));
  }
  return gaps;
}

/// Calls check() with each instruction set that this machine has.
template <class F>
void OnEveryInstructionSet(F&& check) {
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    SCOPED_TRACE(hwy::TargetName(left & -left));
    check();
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST(GrazingSurfaceSimd, SegmentsEqualTheScalarReferenceOnEveryInstructionSet) {
  Rng rng(3);
  MapConfig config;
  std::size_t found = 0, gap_count = 0;
  for (int round = 0; round < 200; ++round) {
    TestFrame random = RandomFrame(rng, 37, 29);
    const double plane = rng.Uniform(0.1, 0.4);
    if (rng.Chance(0.5))  // planes seen at a grazing angle, with edges
      for (int v = 0; v < 29; ++v)
        for (int u = 0; u < 37; ++u)
          random.depth_m.At(u, v) =
              static_cast<float>(1 / (plane + 0.02 * std::abs(u - 15) + 0.3 * (v / 9 % 2)));
    const DepthFrame frame{random.depth_m, random.camera, random.T_world_camera};
    const Gaps gaps = RandomGaps(rng, random.depth_m);
    const std::vector<Ends> expected = LiteralSegments(frame, config, gaps);
    OnEveryInstructionSet([&] {
      Segments segments;
      FindSegments(frame, config, gaps, &segments);
      ASSERT_EQ(Sorted(segments), expected) << "round " << round;
    });
    found += expected.size();
    gap_count += static_cast<std::size_t>(gaps.count);
  }
  EXPECT_GT(found, gap_count / 4);
  EXPECT_LT(found, gap_count);
}

/// On faces and corners too, and along an axis.
Segments RandomSegments(Rng& rng) {
  Segments segments;
  segments.count = rng.Int(0, Segments::kRoom - 16);
  for (int i = 0; i < segments.count; ++i)
    for (int a = 0; a < 3; ++a) {
      const double from = rng.Uniform(-9, 9), length = rng.Normal() * (rng.Chance(0.1) ? 20 : 2);
      segments.a[a][i] = rng.Chance(0.2) ? std::round(from) : from;
      segments.b[a][i] = segments.a[a][i] + (rng.Chance(0.2) ? std::round(length) : length);
    }
  return segments;
}

TEST(GrazingSurfaceSimd, VoxelsEqualThoseOfWalkRayOnEveryInstructionSet) {
  Rng rng(4);
  std::size_t met_count = 0;
  for (int round = 0; round < 200; ++round) {
    const Segments segments = RandomSegments(rng);
    VoxelHashes wanted;
    std::vector<VoxelKey> expected;
    for (int i = 0; i < 300; ++i) wanted.Insert({rng.Int(-9, 9), rng.Int(-9, 9), rng.Int(-9, 9)});
    for (int i = 0; i < segments.count; ++i)
      WalkRay({segments.a[0][i], segments.a[1][i], segments.a[2][i]},
              {segments.b[0][i], segments.b[1][i], segments.b[2][i]}, [&](const VoxelKey& key) {
                if (wanted.Maybe(key)) expected.push_back(key);
                return true;
              });
    std::sort(expected.begin(), expected.end());
    OnEveryInstructionSet([&] {
      std::vector<VoxelKey> met;
      WalkSegments(segments, wanted, &met);
      std::sort(met.begin(), met.end());
      ASSERT_EQ(met, expected) << "round " << round;
    });
    met_count += expected.size();
  }
  EXPECT_GT(met_count, 5000U);
}

TEST(GrazingSurfaceSimd, SegmentsBeyondTheRangeOfKeysAreSkipped) {
  Segments segments;
  for (const double far : {kNone, 1e300, -1e12, std::numeric_limits<double>::infinity()}) {
    segments.a[1][static_cast<std::size_t>(segments.count)] = far;
    segments.b[2][static_cast<std::size_t>(segments.count++)] = 5;
    segments.b[0][static_cast<std::size_t>(segments.count++)] = far;
  }
  segments.b[0][static_cast<std::size_t>(segments.count++)] = 3.5;  // but its neighbour is
  VoxelHashes wanted;
  wanted.Insert({2, 0, 0});
  OnEveryInstructionSet([&] {
    std::vector<VoxelKey> met;
    WalkSegments(segments, wanted, &met);
    EXPECT_EQ(met, std::vector<VoxelKey>(1, VoxelKey{2, 0, 0}));
  });
}

}  // namespace
}  // namespace crossnav::geometry
