// SPDX-License-Identifier: MIT
#include <cmath>

#include "crossnav/scenegraph/box_measures.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::scenegraph {
namespace {

/// Relation of an object over or inside another; empty if neither holds.
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
