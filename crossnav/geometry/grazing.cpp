// SPDX-License-Identifier: MIT
#include "crossnav/geometry/grazing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "crossnav/geometry/back_projection.h"
#include "crossnav/geometry/ray_walk.h"

namespace crossnav::geometry {
namespace {

// chosen: on a plane the inverse depth is linear over the image; its second difference may be this
// share of the first. At an edge in depth one of two neighbouring first differences is near zero.
constexpr double kBend = 0.5;
constexpr double kFarthest_m = 1000;  // chosen: what is farther is no surface of a house

/// Greatest and summed distance of two voxels along the axes.
struct Apart {
  int greatest = 0, sum = 0;
};

Apart ApartOf(const RowEnds& a, int ua, const RowEnds& b, int ub) {
  const int dx = std::abs(a.x[ua] - b.x[ub]), dy = std::abs(a.y[ua] - b.y[ub]),
            dz = std::abs(a.z[ua] - b.z[ub]);
  return {std::max({dx, dy, dz}), dx + dy + dz};
}

void AddGap(MapData& map, const RowEnds& a, int ua, const RowEnds& b, int ub, const PixelGap& gap) {
  const bool is_a = a.x[ua] != kNoEnd, is_b = b.x[ub] != kNoEnd;
  if (!is_a && !is_b) return;
  PixelGap found = gap;
  if (is_a && is_b) {
    const Apart apart = ApartOf(a, ua, b, ub);
    if (apart.sum < 2) return;
    found.is_wide = apart.greatest > 1;
  } else {
    found.is_wide = true;
  }
  map.gaps.push_back(found);
}

/// Inverse depth of a pixel, NaN outside the image or where it says nothing.
double InverseDepth(const DepthFrame& frame, int u, int v) {
  if (!frame.depth_m.Contains(u, v)) return std::nan("");
  const float z = frame.depth_m.At(u, v);
  return z > 0 && z < kFarthest_m ? 1.0 / z : std::nan("");
}

/// True if the surface goes on from pixel to pixel as a plane does, as far as can be seen.
bool IsOnPlane(const DepthFrame& frame, const PixelGap& gap) {
  const int du = gap.is_column ? 0 : 1, dv = gap.is_column ? 1 : 0;
  const auto at = [&](int i) { return InverseDepth(frame, gap.u + i * du, gap.v + i * dv); };
  const double here = at(1) - at(0);
  const auto bends = [&](double step) { return std::abs(step - here) > kBend * std::abs(here); };
  const double before = at(0) - at(-1), after = at(2) - at(1);
  if (std::isnan(here) || (std::isnan(before) && std::isnan(after))) return false;
  return !bends(before) && !bends(after);  // a comparison with NaN is false
}

}  // namespace

void FindGaps(MapData& map, int v, int width, const RowEnds& row, const RowEnds* above) {
  for (int i = 1; i < row.start_count; ++i) {
    const int u = row.starts[i];
    AddGap(map, row, u - 1, row, u, {u - 1, v, false, false});
  }
  if (above == nullptr) return;
  map.changed_pixels.resize(row.starts.size());
  const int count = FindChanges(width, *above, row, map.changed_pixels.data());
  for (int i = 0; i < count; ++i) {
    const int u = map.changed_pixels[i];
    AddGap(map, *above, u, row, u, {u, v - 1, true, false});
  }
}

void SpareSurfacesInGaps(MapData& map, const DepthFrame& frame) {
  GridCursor<VoxelBlock> cursor(map.grid);
  const auto end_of = [&](int u, int v) {
    return BackProjectToVoxels(frame.camera, frame.T_world_camera, u, v, frame.depth_m.At(u, v),
                               map.config.voxel_m);
  };
  for (const PixelGap& gap : map.gaps) {
    if (gap.is_wide && !IsOnPlane(frame, gap)) continue;
    const int u = gap.u + (gap.is_column ? 0 : 1), v = gap.v + (gap.is_column ? 1 : 0);
    WalkRay(end_of(gap.u, gap.v), end_of(u, v), [&](const VoxelKey& key) {
      VoxelBlock* block = cursor.Find(key);
      if (block != nullptr && block->hit.Test(CellIndexOf(key)))
        block->frame_free.Reset(CellIndexOf(key));
      return true;
    });
  }
}

}  // namespace crossnav::geometry
