// SPDX-License-Identifier: MIT
// Points in lanes, and where a view has them on its picture. Per target, as Highway has it: to be
// included after highway.h by files that are compiled once per instruction set. Internal.
#if defined(CROSSNAV_SIM_LANE_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CROSSNAV_SIM_LANE_POINTS_INL_H_
#undef CROSSNAV_SIM_LANE_POINTS_INL_H_
#else
#define CROSSNAV_SIM_LANE_POINTS_INL_H_
#endif

#include "crossnav/sim/render/triangle_clusters.h"

HWY_BEFORE_NAMESPACE();
namespace crossnav::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::CappedTag<float, 8>;
using V = hn::Vec<Wide>;

struct Point {
  V x, y, z;
};

HWY_INLINE Point Minus(const Point& a, const Point& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Point Plus(const Point& a, const Point& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Point Cross(const Point& a, const Point& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE V Dot(const Point& a, const Point& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V Least(V a, V b, V c) {
  return hn::Min(hn::Min(a, b), c);
}
HWY_INLINE V Greatest(V a, V b, V c) {
  return hn::Max(hn::Max(a, b), c);
}

HWY_INLINE Point ToPixels(const RasterView& view, const Point& p_world) {
  const Wide d;
  const Point p = Minus(p_world, {hn::Set(d, view.origin.x()), hn::Set(d, view.origin.y()),
                                  hn::Set(d, view.origin.z())});
  const auto row = [&](int i) {
    return Dot({hn::Set(d, view.to_pixels(i, 0)), hn::Set(d, view.to_pixels(i, 1)),
                hn::Set(d, view.to_pixels(i, 2))},
               p);
  };
  return {row(0), row(1), row(2)};
}

// The line through two corners as a linear function of the pixel: twice q x p, in a form that is
// more exact for close corners. Exchanging the corners gives exactly the negative, so that there is
// no gap between neighbours.
HWY_INLINE Point Line(const Point& p, const Point& q) {
  return Cross(Minus(q, p), Plus(p, q));
}

}  // namespace crossnav::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // CROSSNAV_SIM_LANE_POINTS_INL_H_
