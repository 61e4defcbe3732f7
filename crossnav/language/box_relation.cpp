// SPDX-License-Identifier: MIT
#include "crossnav/language/box_relation.h"

#include <algorithm>
#include <cmath>

#include "crossnav/scenegraph/box_measures.h"

namespace crossnav::language {
namespace {

using scenegraph::CoverOf, scenegraph::GapOf, scenegraph::OverlapOf;
using scenegraph::kCovered, scenegraph::kNear_m, scenegraph::kNextTo_m, scenegraph::kTouch_m;

constexpr double kMissedBy_m = 0.25;     // chosen: two voxels and a half
constexpr double kHardlyCovered = 0.3;   // chosen: likewise
constexpr double kNearMissedBy_m = 0.5;  // chosen: one step
constexpr double kStorey_m = 2.0;        // chosen: boxes on two storeys are not near

Fit Within(double value, double limit, double missed_by) {
  return value <= limit ? Fit::kYes : value <= limit + missed_by ? Fit::kMaybe : Fit::kNo;
}

Fit CoveredFit(const Box3& a, const Box3& b) {
  const double cover = CoverOf(a, b);
  return cover >= kCovered ? Fit::kYes : cover >= kHardlyCovered ? Fit::kMaybe : Fit::kNo;
}

Fit Both(Fit a, Fit b) {
  return std::min(a, b);
}

Fit OnFit(const Box3& a, const Box3& b) {
  const Fit touches = Within(std::abs(a.min.z() - b.max.z()), kTouch_m, kMissedBy_m);
  // Furniture with a back or shelves carries objects below the top of its box.
  const bool is_within = a.min.z() > b.min.z() + kMissedBy_m && a.min.z() < b.max.z();
  return Both(CoveredFit(a, b), std::max(touches, is_within ? Fit::kMaybe : Fit::kNo));
}

Fit InFit(const Box3& a, const Box3& b) {
  const double out_m = std::max({b.min.z() - a.min.z(), a.max.z() - b.max.z(), 0.0});
  const Fit is_smaller = CoverOf(b, a) < kCovered ? Fit::kYes : Fit::kMaybe;
  return Both(Both(CoveredFit(a, b), Within(out_m, kTouch_m, kMissedBy_m)), is_smaller);
}

Fit AboveFit(const Box3& a, const Box3& b) {
  const double below_m = b.max.z() + kTouch_m - a.min.z();
  const Fit is_over = below_m < 0 ? Fit::kYes : below_m < kMissedBy_m ? Fit::kMaybe : Fit::kNo;
  return Both(CoveredFit(a, b), is_over);
}

/// Below `b`, as its support, or on the floor between its legs.
Fit UnderFit(const Box3& a, const Box3& b) {
  const bool is_between = a.max.z() < b.max.z() && a.min.z() <= b.min.z() + kTouch_m;
  const Fit between = is_between ? CoveredFit(a, b) : Fit::kNo;
  return std::max({between, OnFit(b, a), AboveFit(b, a)});
}

}  // namespace

Fit HoldsFor(Relation relation, const Box3& a, const Box3& b) {
  const double gap_m = GapOf(a, b), apart_z_m = -OverlapOf(a, b, 2);
  switch (relation) {
    case Relation::kOn:
      return OnFit(a, b);
    case Relation::kIn:
      return InFit(a, b);
    case Relation::kAbove:
      return AboveFit(a, b);
    case Relation::kUnder:
      return UnderFit(a, b);
    case Relation::kNextTo:
      return Both(Within(gap_m, kNextTo_m, kMissedBy_m), Within(apart_z_m, 0, kMissedBy_m));
    case Relation::kNear:
      return Both(Within(gap_m, kNear_m, kNearMissedBy_m), Within(apart_z_m, kStorey_m, 0));
  }
  return Fit::kNo;
}

}  // namespace crossnav::language
