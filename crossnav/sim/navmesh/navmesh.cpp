// SPDX-License-Identifier: MIT
// Queries on the finished navmesh.
#include "crossnav/sim/navmesh/navmesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>

#include <recastnavigation/DetourCommon.h>
#include <xxhash.h>

#include "crossnav/core/check.h"
#include "crossnav/core/read_file.h"
#include "crossnav/sim/navmesh/navmesh_detail.h"
#include "crossnav/sim/navmesh/surface_path.h"
#include "crossnav/sim/navmesh/walk_graph.h"
#include "crossnav/sim/scene/scene_cache.h"

namespace crossnav::sim {
namespace {

constexpr int kMaxNodes = 65535;       // Detour's own limit
constexpr double kStopShort_m = 0.01;  // chosen: stay off the border, where Detour's ray gets stuck
constexpr double kMaxShort_m = 0.05;   // ... but not far short of it along a grazing direction
constexpr float kOffBorder_m = 0.01F;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{512} << 20;  // chosen: of a navmesh file
constexpr double kSnapXy_m = 0.5, kSnapZ_m = 0.5;

struct OnMesh {
  dtPolyRef ref = 0;
  RecastPoint p{};
};

}  // namespace

struct NavMesh::Impl {
  NavMeshSettings settings;
  DetourMesh mesh;
  DetourQuery query;
  std::optional<WalkGraph> graph;
  dtQueryFilter filter;
  std::uint64_t hash = 0;
  FloorPlan plan;
  std::vector<WorldTriangle> triangles;
  std::vector<double> cumulative_m2;  // of `triangles`
  mutable std::mutex mutex;           // Detour's query keeps scratch memory

  bool Init() {
    query.reset(dtAllocNavMeshQuery());
    if (!query || dtStatusFailed(query->init(mesh.get(), kMaxNodes))) return false;
    filter.setIncludeFlags(kWalkFlag);
    graph.emplace(*mesh);
    plan = FindFloors(*mesh);
    double total = 0;
    ForEachDetailTriangle(*mesh, [&](dtPolyRef, const WorldTriangle& t) {
      triangles.push_back(t);
      total += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
      cumulative_m2.push_back(total);
    });
    return true;
  }

  std::optional<OnMesh> Find(const Vector3d& p_world, double xy_m, double z_m) const {
    if (!p_world.allFinite()) return std::nullopt;
    const RecastPoint p = RecastFromWorld(p_world);
    const RecastPoint half{static_cast<float>(xy_m), static_cast<float>(z_m),
                           static_cast<float>(xy_m)};
    OnMesh found;
    query->findNearestPoly(p.data(), half.data(), &filter, &found.ref, found.p.data());
    if (found.ref == 0) return std::nullopt;
    float height = 0;  // the detail mesh knows it better than the polygon's plane
    if (dtStatusSucceed(query->getPolyHeight(found.ref, found.p.data(), &height))) {
      found.p[1] = height;
    }
    const double across = std::hypot(found.p[0] - p[0], found.p[2] - p[2]);
    if (across > xy_m + 1e-4 || std::abs(found.p[1] - p[1]) > z_m + 1e-4) return std::nullopt;
    return found;
  }

  /// Detour's ray is stuck if it starts on a border: it then begins a centimetre inside, towards
  /// the middle of the (convex) polygon.
  void StepOffBorder(OnMesh& start) const {
    float distance = 0;
    RecastPoint wall{}, normal{};
    const dtStatus status =
        query->findDistanceToWall(start.ref, start.p.data(), 2 * kOffBorder_m, &filter, &distance,
                                  wall.data(), normal.data());
    if (dtStatusFailed(status) || distance >= 0.5F * kOffBorder_m) return;
    const dtMeshTile* tile = nullptr;
    const dtPoly* poly = nullptr;
    if (dtStatusFailed(mesh->getTileAndPolyByRef(start.ref, &tile, &poly))) return;
    RecastPoint middle{};
    for (int i = 0; i < poly->vertCount; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        middle[static_cast<std::size_t>(axis)] +=
            tile->verts[3 * poly->verts[i] + axis] / static_cast<float>(poly->vertCount);
      }
    }
    const float length = std::hypot(middle[0] - start.p[0], middle[2] - start.p[2]);
    if (length > 1e-5F) {
      dtVlerp(start.p.data(), start.p.data(), middle.data(), std::min(1.0F, kOffBorder_m / length));
    }
    query->getPolyHeight(start.ref, start.p.data(), &start.p[1]);
  }

  std::optional<WalkPath> FindShortest(const OnMesh& a, std::span<const SurfacePoint> goals) const {
    return graph->FindShortest({a.ref, WorldFromRecast(a.p.data())}, goals);
  }
};

NavMesh::NavMesh() : impl_(std::make_unique<Impl>()) {}
NavMesh::~NavMesh() = default;
NavMesh::NavMesh(NavMesh&&) noexcept = default;

namespace {

std::uint64_t KeyOf(const Scene& scene, const NavMeshSettings& s) {
  constexpr std::uint64_t kBuilder = 2;  // raise when the same input gives another navmesh
  const std::array<double, 7> numbers{s.agent_height_m, s.agent_radius_m, s.max_climb_m,
                                      s.max_slope_deg,  s.cell_m,         s.cell_height_m,
                                      s.min_island_m2};
  return XXH3_64bits_withSeed(numbers.data(), sizeof(numbers), scene.mesh_hash ^ kBuilder);
}

std::vector<std::uint8_t> ReadBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Result<NavMesh> NavMesh::Build(const Scene& scene, const NavMeshSettings& settings) {
  auto mesh = BuildDetour(scene, settings);
  if (!mesh) return tl::unexpected(mesh.error());
  NavMesh navmesh;
  navmesh.impl_->settings = settings;
  navmesh.impl_->mesh = std::move(*mesh);
  const auto bytes = SaveTiles(*navmesh.impl_->mesh, KeyOf(scene, settings));
  navmesh.impl_->hash = XXH3_64bits(bytes.data(), bytes.size());
  if (!navmesh.impl_->Init() || navmesh.impl_->triangles.empty()) {
    return Fail(ErrorCode::kInvalid, "no walkable ground was found", scene.id);
  }
  return navmesh;
}

Result<NavMesh> NavMesh::BuildCached(const Scene& scene, const NavMeshSettings& settings) {
  const std::uint64_t key = KeyOf(scene, settings);
  char name[64];
  std::snprintf(name, sizeof(name), "%016llx.crossnav.navmesh",
                static_cast<unsigned long long>(key));
  for (const std::filesystem::path& file : CachePlaces(scene.folder, name)) {
    const auto bytes = ReadBytes(file);
    DetourMesh mesh = LoadTiles(bytes, key);
    if (!mesh) continue;
    NavMesh navmesh;
    navmesh.impl_->settings = settings;
    navmesh.impl_->mesh = std::move(mesh);
    navmesh.impl_->hash = XXH3_64bits(bytes.data(), bytes.size());
    if (navmesh.impl_->Init() && !navmesh.impl_->triangles.empty()) return navmesh;
  }
  auto built = Build(scene, settings);
  if (built && !scene.folder.empty()) {
    const auto tiles = SaveTiles(*built->impl_->mesh, key);
    WriteCache(scene.folder, name, {reinterpret_cast<const char*>(tiles.data()), tiles.size()});
  }
  return built;
}

Result<NavMesh> NavMesh::ReadHabitat(const std::filesystem::path& file,
                                     const NavMeshSettings& settings) {
  const auto bytes = ReadFile(file, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  auto mesh = ReadHabitatTiles(*bytes, file.string());
  if (!mesh) return tl::unexpected(mesh.error());
  NavMesh navmesh;
  navmesh.impl_->settings = settings;
  navmesh.impl_->mesh = std::move(*mesh);
  navmesh.impl_->hash = XXH3_64bits(bytes->data(), bytes->size());
  if (!navmesh.impl_->Init() || navmesh.impl_->triangles.empty())
    return Fail(ErrorCode::kInvalid, "holds no walkable ground", file.string());
  return navmesh;
}

Result<NavMesh> NavMesh::Open(const Scene& scene, const NavMeshSettings& settings) {
  if (settings.source != "habitat") return BuildCached(scene, settings);
  for (const char* end : {".basis.navmesh", ".navmesh"}) {
    for (const auto& entry : std::filesystem::directory_iterator(scene.folder)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(end) && !name.ends_with(".crossnav.navmesh"))
        return ReadHabitat(entry.path(), settings);
    }
  }
  return Fail(ErrorCode::kNotFound,
              "has no .navmesh of Habitat, which navmesh.source = habitat asks for",
              scene.folder.string());
}

const NavMeshSettings& NavMesh::settings() const {
  return impl_->settings;
}
std::uint64_t NavMesh::Hash() const {
  return impl_->hash;
}
double NavMesh::AreaM2() const {
  return impl_->plan.area_m2;
}
const std::vector<Floor>& NavMesh::Floors() const {
  return impl_->plan.floors;
}
const std::vector<FloorConnection>& NavMesh::Connections() const {
  return impl_->plan.connections;
}

int NavMesh::FloorOf(const Vector3d& p_world) const {
  int best = 0;
  for (const Floor& floor : Floors()) {
    const double best_m = Floors()[static_cast<std::size_t>(best)].GapTo(p_world.z());
    if (floor.GapTo(p_world.z()) < best_m) best = floor.id;
  }
  return best;
}

std::optional<Vector3d> NavMesh::Snap(const Vector3d& p_world, double xy_m, double z_m) const {
  const std::lock_guard lock(impl_->mutex);
  const auto found = impl_->Find(p_world, xy_m, z_m);
  if (!found) return std::nullopt;
  return WorldFromRecast(found->p.data());
}

std::vector<double> NavMesh::HeightsAt(double x_m, double y_m, double z_low_m,
                                       double z_high_m) const {
  const std::lock_guard lock(impl_->mutex);
  const RecastPoint centre = RecastFromWorld({x_m, y_m, 0.5 * (z_low_m + z_high_m)});
  const RecastPoint half{0.01F, static_cast<float>(0.5 * (z_high_m - z_low_m)), 0.01F};
  std::array<dtPolyRef, 64> polys{};
  int count = 0;
  impl_->query->queryPolygons(centre.data(), half.data(), &impl_->filter, polys.data(), &count,
                              static_cast<int>(polys.size()));
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) {
    RecastPoint closest{};
    bool over = false;
    impl_->query->closestPointOnPoly(polys[static_cast<std::size_t>(i)], centre.data(),
                                     closest.data(), &over);
    const double z = closest[1];
    if (over && z >= z_low_m && z <= z_high_m) heights.push_back(z);
  }
  std::sort(heights.begin(), heights.end());
  const auto same = [](double a, double b) { return b - a < 0.1; };
  heights.erase(std::unique(heights.begin(), heights.end(), same), heights.end());
  return heights;
}

Vector3d NavMesh::WalkStraight(const Vector3d& start_world, const Vector3d& end_world) const {
  const std::lock_guard lock(impl_->mutex);
  auto start = impl_->Find(start_world, kSnapXy_m, kSnapZ_m);
  if (!start || !end_world.allFinite()) return start_world;
  RecastPoint end = RecastFromWorld(end_world);
  impl_->StepOffBorder(*start);
  const double wanted = std::hypot(end[0] - start->p[0], end[2] - start->p[2]);
  if (wanted < 1e-6) return WorldFromRecast(start->p.data());
  std::array<dtPolyRef, 256> visited{};
  dtRaycastHit hit{};
  hit.path = visited.data();
  hit.maxPath = static_cast<int>(visited.size());
  const dtStatus status =
      impl_->query->raycast(start->ref, start->p.data(), end.data(), &impl_->filter, 0, &hit);
  if (dtStatusFailed(status) || hit.pathCount == 0) return WorldFromRecast(start->p.data());
  double share = 1;
  if (hit.t < 1) {
    // Short by the clearance to the wall, which is longer along an oblique direction.
    const double towards_wall = std::abs(hit.hitNormal[0] * (end[0] - start->p[0]) +
                                         hit.hitNormal[2] * (end[2] - start->p[2])) /
                                wanted;
    const double short_m = kStopShort_m / std::max(towards_wall, kStopShort_m / kMaxShort_m);
    share = std::max(0.0, hit.t - short_m / wanted);
  }
  RecastPoint reached{};
  dtVlerp(reached.data(), start->p.data(), end.data(), static_cast<float>(share));
  // The height comes from the polygons that the ray went through, last first: never from a surface
  // above or below.
  for (int i = hit.pathCount - 1; i >= 0; --i) {
    bool over = false;
    RecastPoint closest{};
    const dtPolyRef ref = visited[static_cast<std::size_t>(i)];
    impl_->query->closestPointOnPoly(ref, reached.data(), closest.data(), &over);
    float height = 0;
    if (over && dtStatusSucceed(impl_->query->getPolyHeight(ref, reached.data(), &height))) {
      reached[1] = height;
      return WorldFromRecast(reached.data());
    }
  }
  return WorldFromRecast(start->p.data());
}

std::vector<Vector3d> NavMesh::ShortestPath(const Vector3d& a_world,
                                            const Vector3d& b_world) const {
  const std::lock_guard lock(impl_->mutex);
  const auto a = impl_->Find(a_world, kSnapXy_m, kSnapZ_m);
  const auto b = impl_->Find(b_world, kSnapXy_m, kSnapZ_m);
  if (!a || !b) return {};
  const SurfacePoint goal{b->ref, WorldFromRecast(b->p.data())};
  const auto path = impl_->FindShortest(*a, std::span(&goal, 1));
  if (!path) return {};
  return KeepShape(LiftPath(*impl_->query, *path, WorldFromRecast(a->p.data()), goal.p_world));
}

std::optional<double> NavMesh::Geodesic(const Vector3d& a_world, const Vector3d& b_world) const {
  return Geodesic(a_world, std::span(&b_world, 1));
}

std::optional<double> NavMesh::Geodesic(const Vector3d& a_world,
                                        std::span<const Vector3d> goals_world,
                                        std::size_t* nearest) const {
  return Geodesic(a_world, FindGoals(goals_world), nearest);
}

WalkGoals NavMesh::FindGoals(std::span<const Vector3d> goals_world) const {
  const std::lock_guard lock(impl_->mutex);
  WalkGoals goals;
  for (std::size_t i = 0; i < goals_world.size(); ++i) {
    const auto goal = impl_->Find(goals_world[i], kSnapXy_m, kSnapZ_m);
    if (goal) goals.places.push_back({goal->ref, WorldFromRecast(goal->p.data()), i});
  }
  return goals;
}

std::optional<double> NavMesh::Geodesic(const Vector3d& a_world, const WalkGoals& goals,
                                        std::size_t* nearest) const {
  const std::lock_guard lock(impl_->mutex);
  const auto a = impl_->Find(a_world, kSnapXy_m, kSnapZ_m);
  if (!a) return std::nullopt;
  std::vector<SurfacePoint> ends;
  for (const WalkGoals::Place& place : goals.places) {
    ends.push_back({static_cast<dtPolyRef>(place.polygon), place.p_world});
  }
  const auto path = impl_->FindShortest(*a, ends);
  if (!path) return std::nullopt;
  if (nearest != nullptr) *nearest = goals.places[path->goal].index;
  const auto points =
      LiftPath(*impl_->query, *path, WorldFromRecast(a->p.data()), ends[path->goal].p_world);
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i].p - points[i - 1].p).norm();
  return length;
}

std::optional<Vector3d> NavMesh::RandomPoint(Rng& rng) const {
  const double at = rng.Uniform(0, impl_->cumulative_m2.back());
  const auto it = std::upper_bound(impl_->cumulative_m2.begin(), impl_->cumulative_m2.end(), at);
  const auto index = std::min(static_cast<std::size_t>(it - impl_->cumulative_m2.begin()),
                              impl_->triangles.size() - 1);
  const WorldTriangle& t = impl_->triangles[index];
  const double r = std::sqrt(rng.Uniform()), s = rng.Uniform();
  return Snap((1 - r) * t[0] + r * (1 - s) * t[1] + r * s * t[2]);
}

std::vector<NavMesh::Triangle> NavMesh::Triangles() const {
  std::vector<Triangle> out;
  for (const WorldTriangle& t : impl_->triangles) {
    out.push_back({{t[0].cast<float>(), t[1].cast<float>(), t[2].cast<float>()}});
  }
  return out;
}

}  // namespace crossnav::sim
