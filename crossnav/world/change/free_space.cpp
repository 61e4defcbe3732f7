// SPDX-License-Identifier: MIT
#include "crossnav/world/change/free_space.h"

#include <algorithm>
#include <cmath>

#include "crossnav/world/change/house_view.h"

namespace crossnav::world {
namespace {

constexpr double kMargin_m = 0.02;   // chosen: objects do not touch their neighbours
constexpr double kRays_m = 0.07;     // chosen: few legs and shelves are thinner
constexpr double kSurface_m = 0.04;  // chosen: a rug's pile and the unevenness of scans

/// Values from `low` to `high`, both ends inside, at most kRays_m apart.
std::vector<double> Steps(double low, double high) {
  const int count = std::max(2, static_cast<int>(std::ceil((high - low) / kRays_m)) + 1);
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(low + (high - low) * i / (count - 1));
  return steps;
}

bool IsCarried(const sim::RayCaster& caster, const FreeQuestion& question) {
  const Box3& box = question.box;
  const double inset = 0.1 * std::min(box.max.x() - box.min.x(), box.max.y() - box.min.y());
  for (const double x : Steps(box.min.x() + inset, box.max.x() - inset)) {
    for (const double y : Steps(box.min.y() + inset, box.max.y() - inset)) {
      const auto hit = SurfaceBelow(caster, {x, y, box.max.z()}, question.but,
                                    box.max.z() - box.min.z() + kSurface_m);
      if (!hit || !question.may_carry(hit->instance)) return false;
      if (std::abs(hit->p_world.z() - box.min.z()) > kSurface_m) return false;
    }
  }
  return true;
}

bool IsEmpty(const sim::RayCaster& caster, const FreeQuestion& question) {
  const Vector3d low = question.box.min - Vector3d(kMargin_m, kMargin_m, -kSurface_m - 0.01);
  const Vector3d high = question.box.max + Vector3d(kMargin_m, kMargin_m, 0);
  for (const double z : Steps(std::min(low.z(), high.z() - 0.01), high.z())) {
    for (const int axis : {0, 1}) {
      const int other = 1 - axis;
      const double length_m = high[axis] - low[axis];
      for (const double at : Steps(low[other], high[other])) {
        Vector3d from(low.x(), low.y(), z);
        from[other] = at;
        const Vector3d along = axis == 0 ? Vector3d::UnitX() : Vector3d::UnitY();
        if (FreeLength(caster, from, along, question.but, length_m) < length_m) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool IsFree(const sim::RayCaster& caster, const FreeQuestion& question) {
  return IsCarried(caster, question) && IsEmpty(caster, question);
}

double FreeLength(const sim::RayCaster& caster, const Vector3d& p_world, const Vector3d& direction,
                  int but, double max_m) {
  double walked_m = 0;
  for (int layer = 0; layer < 64 && walked_m < max_m; ++layer) {
    const auto hit = caster.Cast(p_world + walked_m * direction, direction, max_m - walked_m);
    if (!hit) return max_m;
    walked_m += hit->distance_m;
    if (hit->instance != but || but == 0) return walked_m;
    walked_m += 1e-4;
  }
  return max_m;
}

}  // namespace crossnav::world
