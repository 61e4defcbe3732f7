// SPDX-License-Identifier: MIT
// Faces of generated houses that overlap in one plane, found by comparing every pair of triangles.
#include "crossnav/world/mesh/coplanar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/house/embedded_house.h"
#include "crossnav/world/house/house_generator.h"
#include "crossnav/world/mesh/mesh_builder.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::world {
namespace {

constexpr double kPlane_m = 1e-3, kArea_m2 = 1e-4, kParallel = 1e-4;

using Polygon = std::vector<Vector2d>;

double AreaOf(const Polygon& p) {
  double area = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// The part of `polygon` to the left of a -> b.
Polygon LeftOf(const Polygon& polygon, const Vector2d& a, const Vector2d& b) {
  const auto side = [&](const Vector2d& p) {
    const Vector2d ab = b - a, ap = p - a;
    return ab.x() * ap.y() - ab.y() * ap.x();
  };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0) kept.push_back(p);
    if ((sp < 0) != (sq < 0)) kept.push_back(p + (q - p) * (sp / (sp - sq)));
  }
  return kept;
}

struct Triangle {
  std::array<Vector3d, 3> p;
  Vector3d normal = Vector3d::Zero();
  double offset_m = 0, area_m2 = 0;
};

Triangle TriangleAt(const sim::TriangleMesh& mesh, std::size_t t) {
  Triangle out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.p[i] = mesh.vertices[mesh.triangles[t][i]].cast<double>();
  }
  const Vector3d n = (out.p[1] - out.p[0]).cross(out.p[2] - out.p[0]);
  out.area_m2 = 0.5 * n.norm();
  out.normal = n.normalized();
  out.offset_m = out.normal.dot(out.p[0]);
  return out;
}

/// In the plane of `a`, counter-clockwise.
Polygon Flat(const Triangle& a, const std::vector<Vector3d>& points) {
  const Vector3d x = (a.p[1] - a.p[0]).normalized(), y = a.normal.cross(x);
  Polygon polygon;
  for (const Vector3d& p : points) polygon.emplace_back(x.dot(p - a.p[0]), y.dot(p - a.p[0]));
  if (AreaOf(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// The middle of the area that two triangles of one plane share, where it is above 1 cm2.
std::optional<Vector3d> SharedMiddle(const Triangle& a, const Triangle& b) {
  const Polygon clip = Flat(a, {a.p.begin(), a.p.end()});
  Polygon shared = Flat(a, {b.p.begin(), b.p.end()});
  for (std::size_t i = 0; i < 3 && !shared.empty(); ++i) {
    shared = LeftOf(shared, clip[i], clip[(i + 1) % 3]);
  }
  if (shared.size() < 3 || AreaOf(shared) < kArea_m2) return std::nullopt;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : shared) middle += p / static_cast<double>(shared.size());
  const Vector3d x = (a.p[1] - a.p[0]).normalized();
  return a.p[0] + middle.x() * x + middle.y() * a.normal.cross(x);
}

/// Closed solids that may intersect. A ray from a point inside leaves more of them than it enters.
/// All rays have one direction, so that triangles are found by the ray's place in a plane.
class Solids {
 public:
  Solids(const sim::TriangleMesh& mesh, const Vector3d& ray) : ray_(ray.normalized()) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      triangles_.push_back(TriangleAt(mesh, t));
      std::array<long, 2> low = CellOf(triangles_.back().p[0]), high = low;
      for (const Vector3d& p : triangles_.back().p) {
        const auto cell = CellOf(p);
        for (std::size_t k = 0; k < 2; ++k) {
          low[k] = std::min(low[k], cell[k]);
          high[k] = std::max(high[k], cell[k]);
        }
      }
      for (long i = low[0]; i <= high[0]; ++i) {
        for (long j = low[1]; j <= high[1]; ++j) cells_[{i, j}].push_back(t);
      }
    }
  }

  bool IsInside(const Vector3d& p) const {
    int left = 0;
    const auto cell = cells_.find(CellOf(p));
    if (cell == cells_.end()) return false;
    for (const std::size_t t : cell->second) {
      const Triangle& triangle = triangles_[t];
      const double along = triangle.normal.dot(ray_);
      const double ahead_m = (triangle.offset_m - triangle.normal.dot(p)) / along;
      if (ahead_m > 0 && Covers(triangle, p + ahead_m * ray_)) left += along > 0 ? 1 : -1;
    }
    return left > 0;
  }

 private:
  static constexpr double kCell_m = 0.2;

  std::array<long, 2> CellOf(const Vector3d& p) const {
    const auto cell = [&](const Vector3d& axis) { return std::lround(axis.dot(p) / kCell_m); };
    return {cell(across_), cell(ray_.cross(across_))};
  }

  static bool Covers(const Triangle& a, const Vector3d& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d edge = a.p[(i + 1) % 3] - a.p[i];
      if (edge.cross(p - a.p[i]).dot(a.normal) < 0) return false;
    }
    return true;
  }

  const Vector3d ray_;
  const Vector3d across_ = ray_.cross(Vector3d::UnitX()).normalized();
  std::vector<Triangle> triangles_;
  std::map<std::array<long, 2>, std::vector<std::size_t>> cells_;
};

struct VisibleOverlap {
  std::size_t first = 0, second = 0;
  Vector3d middle = Vector3d::Zero();
};

/// The triangles of a scene by their plane.
class Planes {
 public:
  /// `solids`: closed; `mesh`: their surface.
  Planes(const sim::TriangleMesh& solids, const sim::TriangleMesh& mesh) {
    // Along no face and no edge of a house.
    const std::array<Vector3d, 7> rays = {{{0.3127, 0.1743, 0.9311},
                                           {-0.4711, 0.8223, 0.3172},
                                           {0.7713, -0.5371, -0.3373},
                                           {-0.2917, -0.6131, -0.7243},
                                           {0.5519, 0.6337, -0.5471},
                                           {-0.8731, -0.1579, 0.4637},
                                           {0.1193, -0.9127, 0.4021}}};
    for (const Vector3d& ray : rays) {
      solids_.emplace_back(solids, ray);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      triangles_.push_back(TriangleAt(mesh, t));
      const Triangle& added = triangles_.back();
      by_plane_[KeyOf(added.normal, added.offset_m)].push_back(t);
    }
  }

  /// Pairs in one plane, one of them of the shell at least, that are seen from a side which either
  /// faces. The shell's triangles come first.
  std::vector<VisibleOverlap> VisibleOverlaps(std::size_t shell) const {
    std::vector<VisibleOverlap> overlaps;
    for (std::size_t t = 0; t < shell; ++t) {
      const Triangle& a = triangles_[t];
      for (const double side : {1.0, -1.0}) {
        for (const std::size_t other : InPlane(side * a.normal, side * a.offset_m)) {
          if (other <= t && other < shell) continue;  // each pair once
          if (other >= shell && side < 0) continue;   // furniture stands on floors, against walls
          const Triangle& b = triangles_[other];
          const auto middle = SharedMiddle(a, b);
          if (middle && (IsSeen(a, *middle) || IsSeen(b, *middle))) {
            overlaps.push_back({t, other, *middle});
          }
        }
      }
    }
    return overlaps;
  }

 private:
  using Key = std::array<long, 4>;

  static Key KeyOf(const Vector3d& normal, double offset_m) {
    const auto cell = [](double x) { return std::lround(x * 20); };
    return {cell(normal.x()), cell(normal.y()), cell(normal.z()), std::lround(offset_m / kPlane_m)};
  }

  /// Triangles within 1 mm of the plane that face along `normal`.
  std::vector<std::size_t> InPlane(const Vector3d& normal, double offset_m) const {
    std::vector<std::size_t> found;
    for (const int beside : {-1, 0, 1}) {
      Key key = KeyOf(normal, offset_m);
      key[3] += beside;
      const auto near = by_plane_.find(key);
      if (near == by_plane_.end()) continue;
      for (const std::size_t t : near->second) {
        const bool is_parallel = triangles_[t].normal.dot(normal) > 1 - kParallel;
        if (is_parallel && std::abs(triangles_[t].offset_m - offset_m) < kPlane_m) {
          found.push_back(t);
        }
      }
    }
    return found;
  }

  /// In the open before the face at `p`, by most of the rays: some hit an edge.
  bool IsSeen(const Triangle& face, const Vector3d& p) const {
    const double before_m = 0.0003 + face.offset_m - face.normal.dot(p);
    return std::count_if(solids_.begin(), solids_.end(), [&](const Solids& solids) {
             return solids.IsInside(p + before_m * face.normal);
           }) < 4;
  }

  std::vector<Solids> solids_;
  std::vector<Triangle> triangles_;
  std::map<Key, std::vector<std::size_t>> by_plane_;
};

/// "wall / wall: 12 at (...)", the first place of each pair of names.
std::string Listed(const sim::Scene& scene, const std::vector<VisibleOverlap>& overlaps) {
  std::map<std::string, std::pair<int, Vector3d>> pairs;
  for (const VisibleOverlap& o : overlaps) {
    std::array<std::string, 2> names;
    for (std::size_t k = 0; k < 2; ++k) {
      const int id = scene.mesh.triangle_instance[k == 0 ? o.first : o.second];
      names[k] = scene.FindInstance(id)->name;
    }
    std::sort(names.begin(), names.end());
    auto& [count, middle] = pairs[names[0] + " / " + names[1]];
    if (count++ == 0) middle = o.middle;
  }
  std::ostringstream text;
  for (const auto& [names, found] : pairs) {
    text << names << ": " << found.first << ", first at " << found.second.transpose() << '\n';
  }
  return text.str();
}

/// The shell before faces are removed: each wall is a closed box.
sim::Scene SolidsOf(const HousePlan& plan) {
  SceneBuilder scene;
  BuildFloorsAndCeilings(plan, scene);
  BuildWalls(plan, scene);
  BuildStairs(plan, scene);
  BuildBlocks(plan, scene);
  return scene.Finish(plan.id);
}

/// Triangles of the plan without its furniture.
std::size_t ShellTriangles(HousePlan plan) {
  plan.furniture.clear();
  return BuildHouse(plan).mesh.triangles.size();
}

void ExpectNoOverlaps(const HousePlan& plan) {
  const sim::Scene scene = BuildHouse(plan);
  const auto overlaps =
      Planes(SolidsOf(plan).mesh, scene.mesh).VisibleOverlaps(ShellTriangles(plan));
  EXPECT_EQ(overlaps.size(), 0U) << plan.id << '\n' << Listed(scene, overlaps);
}

TEST(Coplanar, NoFacesOfAGeneratedHouseFlicker) {
  int houses = 0;
  for (const int edition : {1, 2}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      HouseParams params;
      params.seed = seed;
      params.edition = edition;
      params.floors = 1 + static_cast<int>(seed % 3);
      params.area_m2 = 90;
      const auto plan = DrawFurnishedPlan(params, 0);
      if (!plan) continue;  // the generator would draw another one
      ++houses;
      SCOPED_TRACE(testing::Message() << "edition " << edition);
      ExpectNoOverlaps(*plan);
    }
  }
  EXPECT_GT(houses, 6);
}

TEST(Coplanar, NoFacesOfTheEmbeddedHouseFlicker) {
  ExpectNoOverlaps(EmbeddedHousePlan());
}

// Depth, collisions and paths stay as they are.
TEST(Coplanar, TheSurfaceOfAHouseStaysWhereItWas) {
  HouseParams params;
  params.seed = 2;
  params.edition = 2;
  params.floors = 2;
  params.area_m2 = 90;
  auto plan = DrawFurnishedPlan(params, 0);
  ASSERT_TRUE(plan) << plan.error().Message();
  plan->furniture.clear();
  const sim::Scene before = SolidsOf(*plan), after = BuildHouse(*plan);
  ASSERT_NE(before.mesh.triangles.size(), after.mesh.triangles.size());
  const sim::RayCaster cast_before(before), cast_after(after);
  const auto paths = sim::NavMesh::Build(before, {}), paths_after = sim::NavMesh::Build(after, {});
  ASSERT_TRUE(paths && paths_after);
  EXPECT_NEAR(paths_after->AreaM2(), paths->AreaM2(), 1e-3 * paths->AreaM2());
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const Vector3d eye = *paths->RandomPoint(rng) + Vector3d(0, 0, rng.Uniform(0.1, 1.6));
    const Vector3d ray = Vector3d(rng.Normal(), rng.Normal(), rng.Normal()).normalized();
    const auto a = cast_before.Cast(eye, ray, 50), b = cast_after.Cast(eye, ray, 50);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ASSERT_NEAR(a->distance_m, b->distance_m, 1e-3) << eye.transpose();
  }
}

double TotalArea(const sim::TriangleMesh& mesh) {
  double area = 0;
  for (const auto& k : mesh.triangles) {
    const Vector3f &a = mesh.vertices[k[0]], &b = mesh.vertices[k[1]], &c = mesh.vertices[k[2]];
    area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
  }
  return area;
}

TEST(Coplanar, TheLargerFaceKeepsWhatTwoShare) {
  MeshBuilder b;
  b.instance = 1;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
  b.instance = 2;
  b.AddQuad({0.8, 0.0005, 0.25}, {3, 0.0005, 0.25}, {3, 0.0005, 0.75}, {0.8, 0.0005, 0.75});
  b.AddQuad({0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});  // faces the other side
  const sim::TriangleMesh cut = WithoutOverlaps(b.mesh());
  EXPECT_NEAR(TotalArea(cut), 1 + 2.2 * 0.5 + 1 - 0.2 * 0.5, 1e-6);
  std::map<int, double> area_of;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    sim::TriangleMesh one = cut;
    one.triangles = {cut.triangles[t]};
    area_of[cut.triangle_instance[t]] += TotalArea(one);
    const Triangle triangle = TriangleAt(cut, t);
    const bool is_third = t + 2 >= cut.triangles.size();
    EXPECT_NEAR(triangle.normal.y(), is_third ? 1 : -1, 1e-6);
  }
  EXPECT_NEAR(area_of[1], 0.9, 1e-6);
  EXPECT_NEAR(area_of[2], 2.1, 1e-6);
}

TEST(Coplanar, TheTextureOfACutFaceStaysWhereItWas) {
  MeshBuilder b;
  b.texture_m = 0.5;
  b.AddQuad({0, 0, 0}, {0, 2, 0}, {-2, 2, 0}, {-2, 0, 0});
  b.AddQuad({0, 1, 0}, {0, 3, 0}, {-1, 3, 0}, {-1, 1, 0});
  const sim::TriangleMesh cut = WithoutOverlaps(b.mesh());
  EXPECT_NEAR(TotalArea(cut), 5, 1e-6);
  for (std::size_t i = 0; i < cut.vertices.size(); ++i) {
    EXPECT_NEAR(cut.uvs[i][0], 2 * cut.vertices[i].x(), 1e-5);
    EXPECT_NEAR(cut.uvs[i][1], 2 * cut.vertices[i].y(), 1e-5);
  }
}

TEST(Coplanar, FacesBesideEachOtherStayAsTheyAre) {
  MeshBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1});
  b.AddBox({1, 0, 0}, {2, 1, 1});
  b.AddBar({0, 0, 0}, {1, 1, 1}, 0.1);
  const sim::TriangleMesh same = WithoutOverlaps(b.mesh());
  EXPECT_EQ(same.triangles, b.mesh().triangles);
  EXPECT_EQ(same.vertices, b.mesh().vertices);
}

}  // namespace
}  // namespace crossnav::world
