// SPDX-License-Identifier: MIT
// Which connected pieces of a fresh navmesh stay. Recast also finds table tops, lofts and roofs;
// the main island holds the most goal objects nearby, then the most ground under cover.
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "crossnav/sim/navmesh/navmesh_detail.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::sim {
namespace {

constexpr double kMinShare =
    0.1;  // chosen: of the main island's area; smaller islands are furniture
constexpr double kMinCover = 0.5;     // chosen: share of an indoor island that has something above
constexpr double kObjectReach_m = 1;  // an object belongs to the nearest island, if within this

struct Island {
  double area_m2 = 0, covered_m2 = 0;
  int objects = 0;  // goal instances that stand on it or hang above it
  bool IsIndoor() const { return covered_m2 >= kMinCover * area_m2; }
};

class IslandFinder {
 public:
  explicit IslandFinder(const dtNavMesh& mesh) : mesh_(mesh) {
    for (int i = 0; i < mesh.getMaxTiles(); ++i) {
      const dtMeshTile* tile = mesh.getTile(i);
      if (tile == nullptr || tile->header == nullptr) continue;
      for (int p = 0; p < tile->header->polyCount; ++p) {
        const dtPolyRef ref = mesh.getPolyRefBase(tile) | static_cast<dtPolyRef>(p);
        if (island_of.count(ref) == 0) Flood(ref);
      }
    }
  }

  std::map<dtPolyRef, std::size_t> island_of;
  std::size_t count = 0;

 private:
  void Flood(dtPolyRef start) {
    std::vector<dtPolyRef> open{start};
    island_of[start] = count;
    while (!open.empty()) {
      const dtMeshTile* tile = nullptr;
      const dtPoly* poly = nullptr;
      mesh_.getTileAndPolyByRefUnsafe(open.back(), &tile, &poly);
      open.pop_back();
      for (unsigned link = poly->firstLink; link != DT_NULL_LINK; link = tile->links[link].next) {
        const dtPolyRef next = tile->links[link].ref;
        if (next != 0 && island_of.emplace(next, count).second) open.push_back(next);
      }
    }
    ++count;
  }

  const dtNavMesh& mesh_;
};

/// The nearest island to a goal object, in plan.
struct Holder {
  const SceneInstance* object = nullptr;
  double distance_m = kObjectReach_m;
  std::size_t island = 0;
};

void Consider(const Vector3d& centre, std::size_t island, Holder& holder) {
  const Box3& box = holder.object->box;
  const double above_m = box.min.z() - centre.z();
  const double distance_m = box.HorizontalDistance(centre);
  if (above_m < -0.3 || above_m > 1.5 || distance_m >= holder.distance_m) return;
  holder.distance_m = distance_m;
  holder.island = island;
}

std::vector<Island> Measure(const dtNavMesh& mesh, const Scene& scene, const IslandFinder& finder) {
  std::vector<Island> islands(finder.count);
  std::vector<Holder> holders;
  for (const SceneInstance& instance : scene.instances) {
    if (!instance.category.empty() && !instance.box.empty()) holders.push_back({&instance});
  }
  const RayCaster caster(scene);
  ForEachDetailTriangle(mesh, [&](dtPolyRef ref, const WorldTriangle& t) {
    const double area_m2 = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    const Vector3d centre = (t[0] + t[1] + t[2]) / 3;
    const std::size_t island = finder.island_of.at(ref);
    islands[island].area_m2 += area_m2;
    if (caster.Cast(centre + Vector3d(0, 0, 0.3), Vector3d::UnitZ(), 20.0)) {
      islands[island].covered_m2 += area_m2;
    }
    for (Holder& holder : holders) {
      for (const Vector3d& p : {centre, t[0], t[1], t[2]}) Consider(p, island, holder);
    }
  });
  for (const Holder& holder : holders) {
    if (holder.distance_m < kObjectReach_m) ++islands[holder.island].objects;
  }
  return islands;
}

bool IsBetter(const Island& a, const Island& b) {
  return std::tuple(a.objects, a.covered_m2, a.area_m2) >
         std::tuple(b.objects, b.covered_m2, b.area_m2);
}

}  // namespace

void DropIslands(dtNavMesh& mesh, const Scene& scene, const NavMeshSettings& settings) {
  const IslandFinder finder(mesh);
  const auto islands = Measure(mesh, scene, finder);
  if (islands.empty()) return;
  const Island& main = *std::min_element(islands.begin(), islands.end(), IsBetter);
  const double least_m2 = std::max(settings.min_island_m2, kMinShare * main.area_m2);
  std::vector<bool> keep;
  for (const Island& island : islands) {
    // Without goal objects to tell a storey from a roof, being indoors has to.
    const bool is_storey =
        main.objects == 0 ? island.IsIndoor() || !main.IsIndoor() : island.objects > 0;
    const bool is_main = &island == &main && island.area_m2 >= settings.min_island_m2;
    keep.push_back(is_main || (island.area_m2 >= least_m2 && is_storey));
  }
  for (const auto& [ref, island] : finder.island_of) {
    if (!keep[island]) mesh.setPolyFlags(ref, 0);
  }
}

}  // namespace crossnav::sim
