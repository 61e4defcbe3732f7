// SPDX-License-Identifier: MIT
// Shared code of navmesh*.cpp: the Detour mesh and the frame change. Recast is y up: (x, z, -y) of
// the world. Private to sim's .cpp files.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshQuery.h>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav::sim {

using RecastPoint = std::array<float, 3>;

/// THE conversions between the world and Recast's frame.
inline RecastPoint RecastFromWorld(const Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.z()), static_cast<float>(-p.y())};
}
inline Vector3d WorldFromRecast(const float* p) {
  return {p[0], -p[2], p[1]};
}

struct DetourRelease {
  void operator()(dtNavMesh* mesh) const { dtFreeNavMesh(mesh); }
  void operator()(dtNavMeshQuery* query) const { dtFreeNavMeshQuery(query); }
};
using DetourMesh = std::unique_ptr<dtNavMesh, DetourRelease>;
using DetourQuery = std::unique_ptr<dtNavMeshQuery, DetourRelease>;

constexpr unsigned short kWalkFlag = 1;  ///< polygons without it are dropped islands

using WorldTriangle = std::array<Vector3d, 3>;

/// Detail triangles (world frame) of every walkable polygon, in tile and polygon order, as
/// fn(dtPolyRef, const WorldTriangle&).
template <class Fn>
void ForEachDetailTriangle(const dtNavMesh& mesh, Fn&& fn) {
  for (int i = 0; i < mesh.getMaxTiles(); ++i) {
    const dtMeshTile* tile = mesh.getTile(i);
    if (tile == nullptr || tile->header == nullptr) continue;
    const dtPolyRef base = mesh.getPolyRefBase(tile);
    for (int p = 0; p < tile->header->polyCount; ++p) {
      const dtPoly& poly = tile->polys[p];
      if ((poly.flags & kWalkFlag) == 0) continue;
      const dtPolyDetail& detail = tile->detailMeshes[p];
      for (unsigned t = 0; t < detail.triCount; ++t) {
        const unsigned char* corner = &tile->detailTris[(detail.triBase + t) * 4];
        WorldTriangle triangle;
        for (unsigned k = 0; k < 3; ++k) {
          const float* v =
              corner[k] < poly.vertCount
                  ? &tile->verts[poly.verts[corner[k]] * 3]
                  : &tile->detailVerts[(detail.vertBase + corner[k] - poly.vertCount) * 3];
          triangle[k] = WorldFromRecast(v);
        }
        fn(base | static_cast<dtPolyRef>(p), triangle);
      }
    }
  }
}

/// Recast pipeline in tiles, islands removed (navmesh_build.cpp).
Result<DetourMesh> BuildDetour(const Scene& scene, const NavMeshSettings& settings);

/// Clears the walk flag of unusable islands (navmesh_islands.cpp).
void DropIslands(dtNavMesh& mesh, const Scene& scene, const NavMeshSettings& settings);

/// Tiles of a mesh as bytes and back, for the cache (navmesh_cache.cpp).
std::vector<std::uint8_t> SaveTiles(const dtNavMesh& mesh, std::uint64_t key);
/// Null unless the bytes are exactly the output of SaveTiles for `key`.
DetourMesh LoadTiles(const std::vector<std::uint8_t>& bytes, std::uint64_t key);

// The first numbers of a file of habitat-sim.
inline constexpr std::int32_t kHabitatMagic = 'M' << 24 | 'S' << 16 | 'E' << 8 | 'T';
inline constexpr std::int32_t kHabitatVersion = 1;

/// Tiles of a file of habitat-sim in our Recast frame (navmesh_habitat_read.cpp). Each tile is
/// checked, because the file is untrusted. Error kMalformed: `where` and the fault.
Result<DetourMesh> ReadHabitatTiles(std::string_view file, const std::string& where);

/// Floors derived from the finished mesh (navmesh_floors.cpp).
struct FloorPlan {
  double area_m2 = 0;
  std::vector<Floor> floors;
  std::vector<FloorConnection> connections;
};
FloorPlan FindFloors(const dtNavMesh& mesh);

}  // namespace crossnav::sim
