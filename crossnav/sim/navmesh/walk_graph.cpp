// SPDX-License-Identifier: MIT
#include "crossnav/sim/navmesh/walk_graph.h"

#include <recastnavigation/DetourCommon.h>

#include <cmath>
#include <limits>

namespace crossnav::sim {
namespace {

constexpr unsigned char kInnerSide = 0xff;  // Detour's mark of a link inside a tile

Vector2d PlanOf(const float* v) {
  return WorldFromRecast(v).head<2>();
}

/// True for each vertex of the tile that touches a wall or the tile's border.
std::vector<char> BorderVertices(const dtMeshTile& tile) {
  std::vector<char> is_border(static_cast<std::size_t>(tile.header->vertCount), 0);
  for (int p = 0; p < tile.header->polyCount; ++p) {
    const dtPoly& poly = tile.polys[p];
    for (int e = 0; e < poly.vertCount; ++e) {
      const bool is_inner = poly.neis[e] != 0 && (poly.neis[e] & DT_EXT_LINK) == 0;
      if (is_inner && (tile.polys[poly.neis[e] - 1].flags & kWalkFlag) != 0) continue;
      is_border[poly.verts[e]] = 1;
      is_border[poly.verts[(e + 1) % poly.vertCount]] = 1;
    }
  }
  return is_border;
}

}  // namespace

WalkGraph::WalkGraph(const dtNavMesh& mesh) {
  for (int i = 0; i < mesh.getMaxTiles(); ++i) {
    const dtMeshTile* tile = mesh.getTile(i);
    if (tile == nullptr || tile->header == nullptr) continue;
    const dtPolyRef base = mesh.getPolyRefBase(tile);
    for (int p = 0; p < tile->header->polyCount; ++p) {
      if ((tile->polys[p].flags & kWalkFlag) == 0) continue;
      index_of_[base | static_cast<dtPolyRef>(p)] = static_cast<int>(polygons_.size());
      polygons_.push_back({base | static_cast<dtPolyRef>(p), -1, {}});
    }
  }
  for (int i = 0; i < mesh.getMaxTiles(); ++i) {
    const dtMeshTile* tile = mesh.getTile(i);
    if (tile == nullptr || tile->header == nullptr) continue;
    const auto is_border = BorderVertices(*tile);
    const dtPolyRef base = mesh.getPolyRefBase(tile);
    for (int p = 0; p < tile->header->polyCount; ++p) {
      const auto found = index_of_.find(base | static_cast<dtPolyRef>(p));
      if (found == index_of_.end()) continue;
      AddPortals(*tile, tile->polys[p], is_border,
                 polygons_[static_cast<std::size_t>(found->second)].portals);
    }
  }
  LinkPortals();
  NumberIslands();
}

int WalkGraph::PointId(const float* v) {
  std::uint64_t key = 0;  // millimetres, 21 bits an axis: +-1 km
  for (int axis = 0; axis < 3; ++axis) {
    const auto mm = static_cast<std::int64_t>(std::floor(v[axis] * 1000.0 + 0.5));
    key = key << 21 | (static_cast<std::uint64_t>(mm) & 0x1fffff);
  }
  const auto [it, is_new] = point_ids_.emplace(key, point_count_);
  if (is_new) ++point_count_;
  return it->second;
}

void WalkGraph::AddPortals(const dtMeshTile& tile, const dtPoly& poly,
                           const std::vector<char>& is_border_vertex,
                           std::vector<Portal>& portals) {
  double doubled_area = 0;
  for (int e = 0; e < poly.vertCount; ++e) {
    const Vector2d a = PlanOf(&tile.verts[poly.verts[e] * 3]);
    const Vector2d b = PlanOf(&tile.verts[poly.verts[(e + 1) % poly.vertCount] * 3]);
    doubled_area += a.x() * b.y() - a.y() * b.x();
  }
  const bool is_ccw = doubled_area > 0;
  for (unsigned l = poly.firstLink; l != DT_NULL_LINK; l = tile.links[l].next) {
    const dtLink& link = tile.links[l];
    const auto to = index_of_.find(link.ref);
    if (to == index_of_.end()) continue;
    const int v0 = poly.verts[link.edge], v1 = poly.verts[(link.edge + 1) % poly.vertCount];
    const float *a = &tile.verts[v0 * 3], *b = &tile.verts[v1 * 3];
    RecastPoint p{a[0], a[1], a[2]}, q{b[0], b[1], b[2]};
    bool p_corner = is_border_vertex[static_cast<std::size_t>(v0)] != 0;
    bool q_corner = is_border_vertex[static_cast<std::size_t>(v1)] != 0;
    if (link.side != kInnerSide) {  // part of an edge on the tile's border
      dtVlerp(p.data(), a, b, static_cast<float>(link.bmin) / 255.0F);
      dtVlerp(q.data(), a, b, static_cast<float>(link.bmax) / 255.0F);
      p_corner = q_corner = true;
    }
    Portal portal;
    portal.to = to->second;
    // The interior is left of the direction of travel around a counter-clockwise polygon: on
    // leaving through the edge, its first end is on the right.
    const RecastPoint &right = is_ccw ? p : q, &left = is_ccw ? q : p;
    portal.right = PlanOf(right.data());
    portal.left = PlanOf(left.data());
    portal.right_id = PointId(right.data());
    portal.left_id = PointId(left.data());
    portal.right_is_corner = is_ccw ? p_corner : q_corner;
    portal.left_is_corner = is_ccw ? q_corner : p_corner;
    if ((portal.left - portal.right).norm() < 1e-4) continue;
    portals.push_back(portal);
  }
}

void WalkGraph::LinkPortals() {
  for (std::size_t i = 0; i < polygons_.size(); ++i) {
    for (Portal& portal : polygons_[i].portals) {
      double nearest = 0.1;  // [m] between the two midpoints; partial portals are rounded
      auto& others = polygons_[static_cast<std::size_t>(portal.to)].portals;
      for (std::size_t k = 0; k < others.size(); ++k) {
        if (others[k].to != static_cast<int>(i)) continue;
        const double apart =
            0.5 * (others[k].left + others[k].right - portal.left - portal.right).norm();
        if (apart >= nearest) continue;
        nearest = apart;
        portal.back = static_cast<int>(k);
      }
    }
  }
}

void WalkGraph::NumberIslands() {
  int count = 0;
  std::vector<int> open;
  for (std::size_t i = 0; i < polygons_.size(); ++i) {
    if (polygons_[i].island >= 0) continue;
    polygons_[i].island = count;
    open.assign(1, static_cast<int>(i));
    while (!open.empty()) {
      const auto at = static_cast<std::size_t>(open.back());
      open.pop_back();
      for (const Portal& portal : polygons_[at].portals) {
        int& island = polygons_[static_cast<std::size_t>(portal.to)].island;
        if (island >= 0) continue;
        island = count;
        open.push_back(portal.to);
      }
    }
    ++count;
  }
}

}  // namespace crossnav::sim
