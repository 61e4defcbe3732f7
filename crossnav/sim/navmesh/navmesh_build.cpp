// SPDX-License-Identifier: MIT
// Triangles -> Recast -> Detour tiles, with the paper's settings (tab:supp_configuration).
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/Recast.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "crossnav/core/cells.h"
#include "crossnav/sim/navmesh/navmesh_detail.h"

namespace crossnav::sim {
namespace {

constexpr int kTileCells =
    256;  // chosen: 7.7 m at 0.03 m; keeps every 16-bit index of Recast far away
constexpr int kMaxTiles = 1024;  // chosen: leaves 12 bits for the polygons of a tile
constexpr int kVertsPerPoly = 6;

template <class T, void (*Free)(T*)>
struct RecastRelease {
  void operator()(T* p) const { Free(p); }
};
using Heightfield = std::unique_ptr<rcHeightfield, RecastRelease<rcHeightfield, rcFreeHeightField>>;
using CompactField = std::unique_ptr<rcCompactHeightfield,
                                     RecastRelease<rcCompactHeightfield, rcFreeCompactHeightfield>>;
using ContourSet = std::unique_ptr<rcContourSet, RecastRelease<rcContourSet, rcFreeContourSet>>;
using PolyMesh = std::unique_ptr<rcPolyMesh, RecastRelease<rcPolyMesh, rcFreePolyMesh>>;
using DetailMesh =
    std::unique_ptr<rcPolyMeshDetail, RecastRelease<rcPolyMeshDetail, rcFreePolyMeshDetail>>;

/// The scene's triangles in Recast's frame.
struct Soup {
  std::vector<float> vertices;      // 3 each
  std::vector<int> triangles;       // 3 each
  std::vector<unsigned char> area;  // RC_WALKABLE_AREA where flat enough, seen from either side
  RecastPoint min{}, max{};
};

Soup MakeSoup(const Scene& scene, double max_slope_deg) {
  Soup soup;
  const TriangleMesh& mesh = scene.mesh;
  soup.min.fill(std::numeric_limits<float>::max());
  soup.max.fill(std::numeric_limits<float>::lowest());
  for (const Vector3f& v : mesh.vertices) {
    const RecastPoint p = RecastFromWorld(v.cast<double>());
    soup.vertices.insert(soup.vertices.end(), p.begin(), p.end());
    for (std::size_t k = 0; k < 3; ++k) {
      soup.min[k] = std::min(soup.min[k], p[k]);
      soup.max[k] = std::max(soup.max[k], p[k]);
    }
  }
  const double min_up = std::cos(DegToRad(max_slope_deg));
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) soup.triangles.push_back(static_cast<int>(v));
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    const Vector3d normal = (b - a).cross(c - a);
    // Winding is not to be trusted in scans and hand-drawn homes, so both sides count.
    const bool walkable = std::abs(normal.z()) > min_up * normal.norm();
    soup.area.push_back(walkable ? RC_WALKABLE_AREA : RC_NULL_AREA);
  }
  return soup;
}

rcConfig MakeConfig(const NavMeshSettings& s, const Soup& soup) {
  rcConfig config{};
  config.cs = static_cast<float>(s.cell_m);
  config.ch = static_cast<float>(s.cell_height_m);
  config.walkableSlopeAngle = static_cast<float>(s.max_slope_deg);
  config.walkableHeight = std::max(CellsCeil(s.agent_height_m, s.cell_height_m), 3);
  config.walkableClimb = CellsFloor(s.max_climb_m, s.cell_height_m);
  config.walkableRadius = CellsCeil(s.agent_radius_m, s.cell_m);
  config.maxEdgeLen = CellsFloor(12.0, s.cell_m);  // as habitat-sim
  config.maxSimplificationError = 1.3F;            // as habitat-sim [cells]
  config.minRegionArea = 64;                       // chosen: 8 x 8 cells, 0.06 m2
  config.mergeRegionArea = 400;
  config.maxVertsPerPoly = kVertsPerPoly;
  config.detailSampleDist = 6 * config.cs;  // as habitat-sim
  config.detailSampleMaxError = config.ch;
  config.tileSize = kTileCells;
  config.borderSize = config.walkableRadius + 3;
  config.width = config.height = config.tileSize + 2 * config.borderSize;
  std::copy(soup.min.begin(), soup.min.end(), config.bmin);
  std::copy(soup.max.begin(), soup.max.end(), config.bmax);
  return config;
}

/// Where a foot comes to that walks straight from `a` to (x, z): at each column the surface nearest
/// to it, if it can be stepped to.
float WalkHeight(const rcCompactHeightfield& field, const RecastPoint& a, float x_m, float z_m,
                 float climb_m) {
  const float length_cells = std::hypot(x_m - a[0], z_m - a[2]) / field.cs;
  const int steps = std::max(1, static_cast<int>(2 * length_cells));
  float height = a[1];
  for (int k = 0; k <= steps; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(steps);
    const int x = static_cast<int>((a[0] + share * (x_m - a[0]) - field.bmin[0]) / field.cs);
    const int z = static_cast<int>((a[2] + share * (z_m - a[2]) - field.bmin[2]) / field.cs);
    if (x < 0 || z < 0 || x >= field.width || z >= field.height) continue;
    const rcCompactCell& cell = field.cells[x + z * field.width];
    float nearest = climb_m, here = height;
    for (unsigned i = 0; i < cell.count; ++i) {
      const float top =
          field.bmin[1] + static_cast<float>(field.spans[cell.index + i].y + 1) * field.ch;
      if (std::abs(top - height) > nearest) continue;
      nearest = std::abs(top - height);
      here = top;
    }
    height = here;
  }
  return height;
}

/// Recast looks up the heights of the detail mesh by column, and where a simplified edge reaches a
/// column of another floor or flight, it takes that: slivers that lead there. A vertex to which no
/// corner of its polygon leads straight gets the height to which the nearest does.
void MendDetail(const rcPolyMesh& polys, const rcCompactHeightfield& field, float climb_m,
                rcPolyMeshDetail& detail) {
  for (int p = 0; p < polys.npolys; ++p) {
    const unsigned short* indices = &polys.polys[2 * p * polys.nvp];
    std::vector<RecastPoint> corners;
    for (int k = 0; k < polys.nvp && indices[k] != RC_MESH_NULL_IDX; ++k) {
      const unsigned short* cells = &polys.verts[3 * indices[k]];
      corners.push_back({polys.bmin[0] + static_cast<float>(cells[0]) * polys.cs,
                         polys.bmin[1] + static_cast<float>(cells[1]) * polys.ch,
                         polys.bmin[2] + static_cast<float>(cells[2]) * polys.cs});
    }
    const unsigned first = detail.meshes[4 * p], count = detail.meshes[4 * p + 1];
    for (std::size_t i = first + corners.size(); i < std::size_t{first} + count; ++i) {
      float* v = &detail.verts[3 * i];
      const auto away = [v](const RecastPoint& c) { return std::hypot(c[0] - v[0], c[2] - v[2]); };
      std::sort(corners.begin(), corners.end(),
                [&](const auto& a, const auto& b) { return away(a) < away(b); });
      std::optional<float> mended;
      for (const RecastPoint& corner : corners) {
        const float height = WalkHeight(field, corner, v[0], v[2], climb_m);
        if (!mended) mended = height;
        if (std::abs(height - v[1]) <= climb_m) mended = v[1];
      }
      v[1] = mended.value_or(v[1]);
    }
  }
}

/// Steps 1 to 7 of Recast's pipeline for one tile. False where Recast runs out of memory.
struct TileBuilder {
  const Soup& soup;
  rcConfig config;  // bmin and bmax of this tile, border included
  rcContext context{false};

  bool Build(const std::vector<int>& triangles, PolyMesh& polys, DetailMesh& detail) {
    Heightfield solid(rcAllocHeightfield());
    if (!solid || !rcCreateHeightfield(&context, *solid, config.width, config.height, config.bmin,
                                       config.bmax, config.cs, config.ch)) {
      return false;
    }
    std::vector<int> corners;
    std::vector<unsigned char> area;
    for (const int t : triangles) {
      for (int k = 0; k < 3; ++k)
        corners.push_back(soup.triangles[3 * static_cast<std::size_t>(t) + k]);
      area.push_back(soup.area[static_cast<std::size_t>(t)]);
    }
    if (!rcRasterizeTriangles(&context, soup.vertices.data(),
                              static_cast<int>(soup.vertices.size() / 3), corners.data(),
                              area.data(), static_cast<int>(area.size()), *solid,
                              config.walkableClimb)) {
      return false;
    }
    rcFilterLowHangingWalkableObstacles(&context, config.walkableClimb, *solid);
    rcFilterLedgeSpans(&context, config.walkableHeight, config.walkableClimb, *solid);
    rcFilterWalkableLowHeightSpans(&context, config.walkableHeight, *solid);

    CompactField field(rcAllocCompactHeightfield());
    if (!field || !rcBuildCompactHeightfield(&context, config.walkableHeight, config.walkableClimb,
                                             *solid, *field)) {
      return false;
    }
    solid.reset();
    if (!rcErodeWalkableArea(&context, config.walkableRadius, *field)) return false;
    // Layer regions never overlap themselves, which watershed ones do on narrow spiral stairs.
    if (!rcBuildLayerRegions(&context, *field, config.borderSize, config.minRegionArea))
      return false;
    return Polygonise(*field, polys, detail);
  }

  bool Polygonise(rcCompactHeightfield& field, PolyMesh& polys, DetailMesh& detail) {
    ContourSet contours(rcAllocContourSet());
    if (!contours || !rcBuildContours(&context, field, config.maxSimplificationError,
                                      config.maxEdgeLen, *contours)) {
      return false;
    }
    polys.reset(rcAllocPolyMesh());
    detail.reset(rcAllocPolyMeshDetail());
    if (!polys || !detail) return false;
    if (contours->nconts == 0) return true;
    if (!rcBuildPolyMesh(&context, *contours, config.maxVertsPerPoly, *polys) ||
        !rcBuildPolyMeshDetail(&context, *polys, field, config.detailSampleDist,
                               config.detailSampleMaxError, *detail)) {
      return false;
    }
    MendDetail(*polys, field, static_cast<float>(config.walkableClimb) * config.ch, *detail);
    return true;
  }
};

struct TilePlace {
  int x = 0, z = 0;
};

bool AddTile(dtNavMesh& mesh, rcPolyMesh& polys, rcPolyMeshDetail& detail, const rcConfig& config,
             const NavMeshSettings& s, TilePlace place) {
  for (int i = 0; i < polys.npolys; ++i) polys.flags[i] = kWalkFlag;
  dtNavMeshCreateParams params{};
  params.verts = polys.verts;
  params.vertCount = polys.nverts;
  params.polys = polys.polys;
  params.polyAreas = polys.areas;
  params.polyFlags = polys.flags;
  params.polyCount = polys.npolys;
  params.nvp = polys.nvp;
  params.detailMeshes = detail.meshes;
  params.detailVerts = detail.verts;
  params.detailVertsCount = detail.nverts;
  params.detailTris = detail.tris;
  params.detailTriCount = detail.ntris;
  params.walkableHeight = static_cast<float>(s.agent_height_m);
  params.walkableRadius = static_cast<float>(s.agent_radius_m);
  params.walkableClimb = static_cast<float>(s.max_climb_m);
  params.tileX = place.x;
  params.tileY = place.z;
  std::copy_n(polys.bmin, 3, params.bmin);
  std::copy_n(polys.bmax, 3, params.bmax);
  params.cs = config.cs;
  params.ch = config.ch;
  params.buildBvTree = true;
  unsigned char* data = nullptr;
  int size = 0;
  if (!dtCreateNavMeshData(&params, &data, &size)) return false;
  if (dtStatusFailed(mesh.addTile(data, size, DT_TILE_FREE_DATA, 0, nullptr))) {
    dtFree(data);
    return false;
  }
  return true;
}

/// Triangles that touch each tile (border included), by tile index x + nx * z.
std::vector<std::vector<int>> BinTriangles(const Soup& soup, const rcConfig& c, int nx, int nz) {
  std::vector<std::vector<int>> bins(static_cast<std::size_t>(nx) * nz);
  const float tile_m = static_cast<float>(c.tileSize) * c.cs;
  const float border_m = static_cast<float>(c.borderSize + 1) * c.cs;
  for (std::size_t t = 0; 3 * t < soup.triangles.size(); ++t) {
    std::array<float, 2> low{1e30F, 1e30F}, high{-1e30F, -1e30F};
    for (std::size_t k = 0; k < 3; ++k) {
      const float* v = &soup.vertices[3 * static_cast<std::size_t>(soup.triangles[3 * t + k])];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], v[2 * axis] - soup.min[2 * axis]);
        high[axis] = std::max(high[axis], v[2 * axis] - soup.min[2 * axis]);
      }
    }
    const auto cell = [tile_m](float m, int n) {
      return std::clamp(static_cast<int>(std::floor(m / tile_m)), 0, n - 1);
    };
    for (int z = cell(low[1] - border_m, nz); z <= cell(high[1] + border_m, nz); ++z) {
      for (int x = cell(low[0] - border_m, nx); x <= cell(high[0] + border_m, nx); ++x) {
        bins[x + static_cast<std::size_t>(nx) * z].push_back(static_cast<int>(t));
      }
    }
  }
  return bins;
}

int BitsFor(int count) {
  int bits = 0;
  while ((1 << bits) < count) ++bits;
  return bits;
}

}  // namespace

Result<DetourMesh> BuildDetour(const Scene& scene, const NavMeshSettings& settings) {
  const Soup soup = MakeSoup(scene, settings.max_slope_deg);
  if (soup.triangles.empty())
    return Fail(ErrorCode::kInvalid, "the scene has no triangles", scene.id);
  const rcConfig config = MakeConfig(settings, soup);
  const double tile_m = config.tileSize * settings.cell_m;
  const double wide_m = soup.max[0] - soup.min[0], deep_m = soup.max[2] - soup.min[2];
  const double tiles = std::ceil(wide_m / tile_m + 1e-9) * std::ceil(deep_m / tile_m + 1e-9);
  if (tiles > kMaxTiles || (soup.max[1] - soup.min[1]) / settings.cell_height_m > 8000) {
    return Fail(ErrorCode::kUnsupported,
                "the scene is too large for navmesh cells of " + std::to_string(settings.cell_m) +
                    " m; set a larger cell_m",
                scene.id);
  }
  const int nx = std::max(1, static_cast<int>(std::ceil(wide_m / tile_m + 1e-9)));
  const int nz = std::max(1, static_cast<int>(std::ceil(deep_m / tile_m + 1e-9)));

  DetourMesh mesh(dtAllocNavMesh());
  dtNavMeshParams params{};
  std::copy(soup.min.begin(), soup.min.end(), params.orig);
  params.tileWidth = params.tileHeight = static_cast<float>(config.tileSize) * config.cs;
  const int tile_bits = BitsFor(nx * nz);
  params.maxTiles = 1 << tile_bits;
  params.maxPolys = 1 << std::min(22 - tile_bits, 16);
  const auto failed = [&scene](const char* what) {
    return Fail(ErrorCode::kUnsupported, what, scene.id);
  };
  if (!mesh || dtStatusFailed(mesh->init(&params)))
    return failed("Detour cannot hold this navmesh");

  const auto bins = BinTriangles(soup, config, nx, nz);
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      const auto& triangles = bins[x + static_cast<std::size_t>(nx) * z];
      if (triangles.empty()) continue;
      TileBuilder builder{soup, config};
      const float border_m = static_cast<float>(config.borderSize) * config.cs;
      builder.config.bmin[0] = soup.min[0] + static_cast<float>(x) * params.tileWidth - border_m;
      builder.config.bmin[2] = soup.min[2] + static_cast<float>(z) * params.tileHeight - border_m;
      builder.config.bmax[0] =
          soup.min[0] + static_cast<float>(x + 1) * params.tileWidth + border_m;
      builder.config.bmax[2] =
          soup.min[2] + static_cast<float>(z + 1) * params.tileHeight + border_m;
      PolyMesh polys;
      DetailMesh detail;
      if (!builder.Build(triangles, polys, detail)) return failed("Recast failed on a tile");
      if (polys->npolys == 0) continue;
      if (polys->npolys > params.maxPolys) return failed("a navmesh tile has too many polygons");
      if (!AddTile(*mesh, *polys, *detail, config, settings, {x, z})) {
        return failed("Detour refuses a tile");
      }
    }
  }
  DropIslands(*mesh, scene, settings);
  return mesh;
}

}  // namespace crossnav::sim
