// SPDX-License-Identifier: MIT
// Shortest paths against a visibility graph over the mesh's border, and against Detour's own
// search.
#include "crossnav/sim/navmesh/walk_graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/core/rng.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A flat room with `count` random boxes, small enough for one tile of the navmesh.
Scene Clutter(std::uint64_t seed, int count) {
  Rng rng(seed);
  MicroScene m;
  m.Room(0, 0, 6.5, 6.5);
  m.Begin("box");
  for (int i = 0; i < count; ++i) {
    const double x = rng.Uniform(0.3, 5.5), y = rng.Uniform(0.3, 5.5);
    m.Box({x, y, 0}, {x + rng.Uniform(0.2, 1.6), y + rng.Uniform(0.2, 1.6), 2});
  }
  return m.Finish();
}

struct Border {
  Vector2d a, b;
};

/// Edges of the mesh without a neighbour, in plan.
std::vector<Border> BordersOf(const dtNavMesh& mesh) {
  std::vector<Border> borders;
  for (int i = 0; i < mesh.getMaxTiles(); ++i) {
    const dtMeshTile* tile = mesh.getTile(i);
    if (tile == nullptr || tile->header == nullptr) continue;
    for (int p = 0; p < tile->header->polyCount; ++p) {
      const dtPoly& poly = tile->polys[p];
      if ((poly.flags & kWalkFlag) == 0) continue;
      for (int e = 0; e < poly.vertCount; ++e) {
        if (poly.neis[e] != 0) continue;
        const auto at = [&](int k) {
          return Vector2d(
              WorldFromRecast(&tile->verts[poly.verts[k % poly.vertCount] * 3]).head<2>());
        };
        borders.push_back({at(e), at(e + 1)});
      }
    }
  }
  return borders;
}

/// True if the open segment p-q crosses no border. Touching corners is allowed.
bool Sees(const std::vector<Border>& borders, const Vector2d& p, const Vector2d& q) {
  const double eps = 1e-6;
  for (const Border& border : borders) {
    const Vector2d d = q - p, e = border.b - border.a;
    const double a = Cross(d, border.a - p) / std::max(d.norm(), 1e-12);
    const double b = Cross(d, border.b - p) / std::max(d.norm(), 1e-12);
    const double s = Cross(e, p - border.a) / e.norm(), t = Cross(e, q - border.a) / e.norm();
    if (a * b < 0 && s * t < 0 &&
        std::min({std::abs(a), std::abs(b), std::abs(s), std::abs(t)}) > eps) {
      return false;
    }
  }
  return true;
}

/// Even-odd rule over the borders: a midpoint inside tells a chord through an obstacle's corner
/// pair.
bool IsInside(const std::vector<Border>& borders, const Vector2d& p) {
  bool inside = false;
  for (const Border& b : borders) {
    if ((b.a.y() > p.y()) == (b.b.y() > p.y())) continue;
    const double x = b.a.x() + (p.y() - b.a.y()) / (b.b.y() - b.a.y()) * (b.b.x() - b.a.x());
    if (x > p.x()) inside = !inside;
  }
  return inside;
}

bool Joined(const std::vector<Border>& borders, const Vector2d& p, const Vector2d& q) {
  if ((p - q).norm() < 1e-9) return true;
  if (!Sees(borders, p, q)) return false;
  for (const double share : {0.01, 0.25, 0.5, 0.75, 0.99}) {
    const Vector2d m = p + share * (q - p);
    bool on_border = false;
    for (const Border& b : borders) {
      const Vector2d e = b.b - b.a;
      const double t = std::clamp((m - b.a).dot(e) / e.squaredNorm(), 0.0, 1.0);
      on_border |= (b.a + t * e - m).norm() < 1e-6;
    }
    if (!on_border && !IsInside(borders, m)) return false;
  }
  return true;
}

/// Dijkstra over start, goal and all border corners.
double VisibilityGraphDistance(const std::vector<Border>& borders, const Vector2d& start,
                               const Vector2d& goal) {
  std::vector<Vector2d> points{start, goal};
  for (const Border& border : borders) points.push_back(border.a);
  std::vector<double> g(points.size(), 1e30);
  std::vector<bool> done(points.size(), false);
  g[0] = 0;
  for (std::size_t round = 0; round < points.size(); ++round) {
    std::size_t best = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!done[i] && (best == points.size() || g[i] < g[best])) best = i;
    }
    if (best == 1 || g[best] > 1e29) break;
    done[best] = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double through = g[best] + (points[i] - points[best]).norm();
      if (!done[i] && through < g[i] && Joined(borders, points[best], points[i])) g[i] = through;
    }
  }
  return g[1];
}

struct Searcher {
  DetourMesh mesh;
  DetourQuery query{dtAllocNavMeshQuery()};
  dtQueryFilter filter;
  WalkGraph graph;

  explicit Searcher(const Scene& scene) : mesh(*BuildDetour(scene, {})), graph(*mesh) {
    query->init(mesh.get(), 65535);
    filter.setIncludeFlags(kWalkFlag);
  }

  SurfacePoint At(const Vector3d& p) const {
    SurfacePoint found;
    RecastPoint nearest{};
    const RecastPoint at = RecastFromWorld(p), half{1, 0.5, 1};
    query->findNearestPoly(at.data(), half.data(), &filter, &found.ref, nearest.data());
    found.p_world = WorldFromRecast(nearest.data());
    return found;
  }

  std::optional<double> DetourLength(const SurfacePoint& a, const SurfacePoint& b) const {
    std::vector<dtPolyRef> polys(4096);
    std::vector<float> corners(3 * 4096);
    int count = 0, corner_count = 0;
    const RecastPoint p = RecastFromWorld(a.p_world), q = RecastFromWorld(b.p_world);
    query->findPath(a.ref, b.ref, p.data(), q.data(), &filter, polys.data(), &count, 4096);
    if (count == 0 || polys[static_cast<std::size_t>(count) - 1] != b.ref) return std::nullopt;
    query->findStraightPath(p.data(), q.data(), polys.data(), count, corners.data(), nullptr,
                            nullptr, &corner_count, 4096);
    double length = 0;
    for (int i = 1; i < corner_count; ++i) {
      const float *u = &corners[static_cast<std::size_t>(3 * i - 3)], *v = u + 3;
      length += std::hypot(v[0] - u[0], v[2] - u[2]);
    }
    return length;
  }
};

TEST(WalkGraph, AgreesWithAVisibilityGraphInClutter) {
  int bent = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Searcher searcher(Clutter(seed, 8));
    const auto borders = BordersOf(*searcher.mesh);
    Rng rng(seed);
    for (int i = 0; i < 8; ++i) {
      const auto a = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
      const auto b = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
      if (a.ref == 0 || b.ref == 0) continue;
      const Vector2d p = a.p_world.head<2>(), q = b.p_world.head<2>();
      const double expected = VisibilityGraphDistance(borders, p, q);
      const auto path = searcher.graph.FindShortest(a, std::span(&b, 1));
      ASSERT_EQ(path.has_value(), expected < 1e29) << "seed " << seed << " pair " << i;
      if (!path) continue;
      EXPECT_NEAR(path->plan_length_m, expected, 1e-3) << "seed " << seed << " pair " << i;
      bent += path->corners.size() > 2 ? 1 : 0;
    }
  }
  EXPECT_GT(bent, 10);  // the test would be empty if every path were straight
}

TEST(WalkGraph, IsNeverLongerThanDetourAndReachesWhatDetourReaches) {
  double ours = 0, detours = 0;
  for (const bool stairs : {false, true}) {
    const Searcher searcher(stairs ? TwoFloors() : Clutter(17, 10));
    Rng rng(2);
    for (int i = 0; i < 150; ++i) {
      const auto a = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 5.8), 0});
      const auto b = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 5.8), stairs ? 3.0 : 0});
      if (a.ref == 0 || b.ref == 0) continue;
      const auto path = searcher.graph.FindShortest(a, std::span(&b, 1));
      const auto detour = searcher.DetourLength(a, b);
      ASSERT_EQ(path.has_value(), detour.has_value());
      if (!path) continue;
      EXPECT_LE(path->plan_length_m, *detour + 1e-3);
      EXPECT_GE(path->plan_length_m, (a.p_world - b.p_world).head<2>().norm() - 1e-6);
      ours += path->plan_length_m;
      detours += *detour;
    }
  }
  EXPECT_LT(ours, detours);
}

TEST(WalkGraph, PiecesJoinTheCornersWithoutGaps) {
  const Searcher searcher(Clutter(3, 8));
  Rng rng(8);
  for (int i = 0; i < 60; ++i) {
    const auto a = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
    const auto b = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
    if (a.ref == 0 || b.ref == 0) continue;
    const auto path = searcher.graph.FindShortest(a, std::span(&b, 1));
    if (!path) continue;
    Vector2d at = a.p_world.head<2>();
    double length = 0;
    for (const PathPiece& piece : path->pieces) {
      EXPECT_LT((piece.from - at).norm(), 1e-6);
      at = piece.to;
      length += (piece.to - piece.from).norm();
    }
    EXPECT_LT((at - b.p_world.head<2>()).norm(), 1e-6);
    EXPECT_NEAR(length, path->plan_length_m, 1e-5);
  }
}

TEST(WalkGraph, BackwardsIsAsLongAsForwards) {
  const Searcher searcher(Clutter(5, 9));
  Rng rng(6);
  for (int i = 0; i < 100; ++i) {
    const auto a = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
    const auto b = searcher.At({rng.Uniform(0.2, 6.3), rng.Uniform(0.2, 6.3), 0});
    if (a.ref == 0 || b.ref == 0) continue;
    const auto there = searcher.graph.FindShortest(a, std::span(&b, 1));
    const auto back = searcher.graph.FindShortest(b, std::span(&a, 1));
    ASSERT_EQ(there.has_value(), back.has_value());
    if (!there) continue;
    EXPECT_NEAR(there->plan_length_m, back->plan_length_m, 1e-5);
  }
}

}  // namespace
}  // namespace crossnav::sim::test
