// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::scenegraph {
namespace {

constexpr double kTouch_m = 0.15;  // chosen: a voxel and a half between two surfaces
constexpr double kNextTo_m = 0.5;  // chosen: too narrow to walk between
constexpr double kNear_m = 1.5;    // chosen: within an arm and a step
constexpr double kCovered = 0.5;   // chosen: share of the upper object's ground plan

double OverlapOf(const Box3& a, const Box3& b, int axis) {
  return std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
}

/// Share of the ground plan of `a` that lies over the plan of `b`.
double CoverOf(const Box3& a, const Box3& b) {
  const double dx = std::max(0.0, OverlapOf(a, b, 0)), dy = std::max(0.0, OverlapOf(a, b, 1));
  const Vector3d size = a.max - a.min;
  return size.x() * size.y() > 0 ? dx * dy / (size.x() * size.y()) : 0;
}

double GapOf(const Box3& a, const Box3& b) {
  return std::hypot(std::max(0.0, -OverlapOf(a, b, 0)), std::max(0.0, -OverlapOf(a, b, 1)));
}

/// Whether `a` lies over or inside `b`; empty where neither holds.
std::optional<RelationKind> OverOf(const Box3& a, const Box3& b) {
  if (CoverOf(a, b) < kCovered) return std::nullopt;
  if (std::abs(a.min.z() - b.max.z()) <= kTouch_m) return RelationKind::kOn;
  if (a.min.z() > b.max.z()) return RelationKind::kAbove;
  const bool is_inside = a.min.z() >= b.min.z() - kTouch_m && a.max.z() <= b.max.z() + kTouch_m &&
                         CoverOf(b, a) < kCovered;
  return is_inside ? std::optional(RelationKind::kIn) : std::nullopt;
}

std::optional<RelationKind> BesideOf(const Box3& a, const Box3& b) {
  const double gap_m = GapOf(a, b);
  if (gap_m <= kNextTo_m && OverlapOf(a, b, 2) > 0) return RelationKind::kNextTo;
  return gap_m <= kNear_m ? std::optional(RelationKind::kNear) : std::nullopt;
}

void Relate(const GraphObject& a, const GraphObject& b, std::vector<GraphRelation>& relations) {
  if (const auto over = OverOf(a.box, b.box)) return relations.push_back({*over, a.id, b.id});
  if (const auto over = OverOf(b.box, a.box)) return relations.push_back({*over, b.id, a.id});
  if (a.room != b.room) return;  // a wall lies between
  if (const auto beside = BesideOf(a.box, b.box)) relations.push_back({*beside, a.id, b.id});
}

}  // namespace

void RelateObjects(SceneGraph& graph) {
  graph.relations.clear();
  for (std::size_t i = 0; i < graph.objects.size(); ++i)
    for (std::size_t j = i + 1; j < graph.objects.size(); ++j)
      if (graph.objects[i].floor && graph.objects[i].floor == graph.objects[j].floor)
        Relate(graph.objects[i], graph.objects[j], graph.relations);
}

}  // namespace crossnav::scenegraph
