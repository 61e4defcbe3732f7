// SPDX-License-Identifier: MIT
// habitat-sim's navmesh files as a mesh in our Recast frame. Detour trusts its tiles, so each is
// taken apart with checks and made anew, turned by 90 degrees about the vertical:
// (x, y, z) of Habitat is (-z, y, x) of our Recast frame.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>

#include <recastnavigation/DetourAlloc.h>
#include <recastnavigation/DetourNavMeshBuilder.h>

#include "crossnav/sim/navmesh/habitat_navmesh.h"
#include "crossnav/sim/navmesh/navmesh_detail.h"

namespace crossnav::sim {
namespace {

constexpr std::int32_t kMostTiles = 100000;
constexpr int kCorners = DT_VERTS_PER_POLYGON;
constexpr float kFarthest_m = 1e5F;         // chosen: beyond it no number is a place
constexpr unsigned short kBorder = 0xffff;  // Recast's mark of an edge without a neighbour
constexpr float kHeightSteps = 60000;       // chosen: of 65535, over a tile's height

using Problem = const char*;  // nullptr = none

/// Bytes that are taken in order; `is_short` once more was asked than there is.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_(bytes) {}
  template <class T>
  T Take() {
    T value{};
    TakeInto(&value, sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> TakeAll(int count) {
    const auto size = static_cast<std::size_t>(std::max(count, 0)) * sizeof(T);
    if (count < 0 || size > left_.size()) is_short = true;
    std::vector<T> all(is_short ? 0 : static_cast<std::size_t>(count));
    if (!all.empty()) TakeInto(all.data(), size);
    return all;
  }
  std::string_view TakeView(std::size_t size) {
    if (size > left_.size()) is_short = true;
    const auto view = left_.substr(0, is_short ? 0 : size);
    left_.remove_prefix(view.size());
    return view;
  }
  std::size_t left() const { return left_.size(); }
  bool is_short = false;

 private:
  void TakeInto(void* target, std::size_t size) {
    const auto view = TakeView(size);
    if (view.size() == size) std::memcpy(target, view.data(), size);
  }
  std::string_view left_;
};

struct Tile {
  dtMeshHeader header{};
  std::vector<float> vertices;
  std::vector<dtPoly> polys;
  std::vector<dtPolyDetail> details;
  std::vector<float> detail_vertices;
  std::vector<unsigned char> detail_triangles;
};

bool ArePlaces(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [](float x) { return std::isfinite(x) && std::abs(x) < kFarthest_m; });
}

/// Recast's direction (0 = -x, 1 = +z, 2 = +x, 3 = -z) of a portal of Detour.
int DirectionOf(unsigned short neighbour) {
  return (4 - (neighbour & 0x7fff)) / 2 & 3;
}

Problem CheckPoly(const Tile& tile, const dtPoly& poly, const dtPolyDetail& detail) {
  const dtMeshHeader& h = tile.header;
  if (poly.vertCount < 3 || poly.vertCount > kCorners) return "a polygon has no 3 to 6 corners";
  for (int i = 0; i < poly.vertCount; ++i) {
    if (poly.verts[i] >= h.vertCount) return "a polygon names a vertex that is not there";
    const unsigned short neighbour = poly.neis[i];
    const bool is_portal = (neighbour & DT_EXT_LINK) != 0;
    if (is_portal && ((neighbour & 0x7fff) > 6 || neighbour % 2 != 0))
      return "a polygon has an unknown side";
    if (!is_portal && neighbour > h.polyCount)
      return "a polygon names a neighbour that is not there";
  }
  const auto triangles = static_cast<std::uint64_t>(h.detailTriCount);
  const auto vertices = static_cast<std::uint64_t>(h.detailVertCount);
  if (std::uint64_t{detail.triBase} + detail.triCount > triangles ||
      std::uint64_t{detail.vertBase} + detail.vertCount > vertices)
    return "the height detail lies outside of its tile";
  for (unsigned t = 0; t < detail.triCount; ++t)
    for (unsigned k = 0; k < 3; ++k)
      if (tile.detail_triangles[(detail.triBase + t) * 4 + k] >= poly.vertCount + detail.vertCount)
        return "a triangle names a vertex that is not there";
  return nullptr;
}

Problem ReadTile(std::string_view data, Tile& tile) {
  static_assert(sizeof(dtMeshHeader) % 4 == 0 && sizeof(dtPoly) == 32 &&
                sizeof(dtPolyDetail) == 12 && sizeof(dtLink) == 12);
  Bytes bytes(data);
  const auto h = tile.header = bytes.Take<dtMeshHeader>();
  if (h.magic != DT_NAVMESH_MAGIC || h.version != DT_NAVMESH_VERSION)
    return "a tile is of another version of Detour";
  if (h.polyCount < 0 || h.vertCount < 0 || h.vertCount >= 0xffff || h.polyCount >= 0x7fff ||
      h.detailMeshCount != h.offMeshBase || h.offMeshBase > h.polyCount || h.offMeshBase < 0)
    return "the counts of a tile contradict each other";
  tile.vertices = bytes.TakeAll<float>(3 * h.vertCount);
  tile.polys = bytes.TakeAll<dtPoly>(h.polyCount);
  bytes.TakeAll<dtLink>(h.maxLinkCount);
  tile.details = bytes.TakeAll<dtPolyDetail>(h.detailMeshCount);
  if (h.detailVertCount > 0x1000000 || h.detailTriCount > 0x1000000) return "a tile is too large";
  tile.detail_vertices = bytes.TakeAll<float>(3 * h.detailVertCount);
  tile.detail_triangles = bytes.TakeAll<unsigned char>(4 * h.detailTriCount);
  if (bytes.is_short) return "a tile is shorter than it says";
  if (!ArePlaces(tile.vertices) || !ArePlaces(tile.detail_vertices) || !ArePlaces(h.bmin) ||
      !ArePlaces(h.bmax) || !(h.bvQuantFactor > 0.1F && h.bvQuantFactor < 1e4F))
    return "a tile holds numbers that are no places";
  tile.polys.resize(static_cast<std::size_t>(h.offMeshBase));  // without jump links
  tile.header.polyCount = h.offMeshBase;
  for (std::size_t i = 0; i < tile.polys.size(); ++i)
    if (Problem problem = CheckPoly(tile, tile.polys[i], tile.details[i])) return problem;
  return nullptr;
}

/// Input of dtCreateNavMeshData, rotated.
struct TurnedTile {
  std::vector<unsigned short> vertices, polys, flags;
  std::vector<unsigned char> areas, triangles;
  std::vector<unsigned> details;
  std::vector<float> detail_vertices;
};

void AppendTurned(std::vector<float>& out, const float* p) {
  out.insert(out.end(), {-p[2], p[1], p[0]});
}

void AppendPoly(const Tile& tile, std::size_t index, TurnedTile& out) {
  const dtPoly& poly = tile.polys[index];
  for (int i = 0; i < kCorners; ++i)
    out.polys.push_back(i < poly.vertCount ? poly.verts[i] : kBorder);
  for (int i = 0; i < kCorners; ++i) {
    const unsigned short neighbour = i < poly.vertCount ? poly.neis[i] : 0;
    if ((neighbour & DT_EXT_LINK) != 0) {
      out.polys.push_back(
          static_cast<unsigned short>(DT_EXT_LINK | (DirectionOf(neighbour) + 3) % 4));
    } else {
      out.polys.push_back(neighbour == 0 ? kBorder : static_cast<unsigned short>(neighbour - 1));
    }
  }
  out.flags.push_back(poly.flags);
  out.areas.push_back(poly.getArea());
  const dtPolyDetail& detail = tile.details[index];
  const auto corners = static_cast<unsigned>(poly.vertCount);
  out.details.insert(
      out.details.end(),
      {static_cast<unsigned>(out.detail_vertices.size() / 3), corners + detail.vertCount,
       static_cast<unsigned>(out.triangles.size() / 4), detail.triCount});
  for (unsigned i = 0; i < corners; ++i)
    AppendTurned(out.detail_vertices, &tile.vertices[3U * poly.verts[i]]);
  for (unsigned i = 0; i < detail.vertCount; ++i)
    AppendTurned(out.detail_vertices, &tile.detail_vertices[3 * (detail.vertBase + i)]);
  const auto first =
      tile.detail_triangles.begin() + 4 * static_cast<std::ptrdiff_t>(detail.triBase);
  out.triangles.insert(out.triangles.end(), first, first + 4 * detail.triCount);
}

Problem AddTurned(const Tile& tile, int rows, dtNavMesh& mesh) {
  const dtMeshHeader& h = tile.header;
  if (tile.polys.empty()) return nullptr;
  dtNavMeshCreateParams params{};
  const float low[3] = {-h.bmax[2], h.bmin[1], h.bmin[0]};
  const float high[3] = {-h.bmin[2], h.bmax[1], h.bmax[0]};
  std::copy_n(low, 3, params.bmin);
  std::copy_n(high, 3, params.bmax);
  params.cs = 1 / h.bvQuantFactor;
  params.ch = std::max(1e-4F, (high[1] - low[1]) / kHeightSteps);
  TurnedTile turned;
  for (int i = 0; i < h.vertCount; ++i) {
    const float* p = &tile.vertices[3 * static_cast<std::size_t>(i)];
    const float at[3] = {(-p[2] - low[0]) / params.cs, (p[1] - low[1]) / params.ch,
                         (p[0] - low[2]) / params.cs};
    for (const float x : at) {
      if (!(x > -1 && x < 65534)) return "a vertex lies outside of its tile";
      turned.vertices.push_back(static_cast<unsigned short>(std::lround(std::max(x, 0.0F))));
    }
  }
  for (std::size_t i = 0; i < tile.polys.size(); ++i) AppendPoly(tile, i, turned);
  params.verts = turned.vertices.data();
  params.vertCount = h.vertCount;
  params.polys = turned.polys.data();
  params.polyFlags = turned.flags.data();
  params.polyAreas = turned.areas.data();
  params.polyCount = h.polyCount;
  params.nvp = kCorners;
  params.detailMeshes = turned.details.data();
  params.detailVerts = turned.detail_vertices.data();
  params.detailVertsCount = static_cast<int>(turned.detail_vertices.size() / 3);
  params.detailTris = turned.triangles.data();
  params.detailTriCount = static_cast<int>(turned.triangles.size() / 4);
  params.walkableHeight = h.walkableHeight;
  params.walkableRadius = h.walkableRadius;
  params.walkableClimb = h.walkableClimb;
  params.tileX = rows - 1 - h.y;
  params.tileY = h.x;
  params.tileLayer = h.layer;
  params.buildBvTree = true;
  unsigned char* data = nullptr;
  int size = 0;
  if (!dtCreateNavMeshData(&params, &data, &size)) return "a tile cannot be made anew";
  if (dtStatusFailed(mesh.addTile(data, size, DT_TILE_FREE_DATA, 0, nullptr))) {
    dtFree(data);
    return "two tiles have one place";
  }
  return nullptr;
}

Problem ReadTiles(Bytes& bytes, std::int32_t count, std::vector<Tile>& tiles) {
  for (std::int32_t i = 0; i < count; ++i) {
    bytes.Take<dtTileRef>();
    const auto size = bytes.Take<std::int32_t>();
    if (bytes.is_short || size < 0) return "the file ends within a tile";
    const auto data = bytes.TakeView(static_cast<std::size_t>(size));
    if (bytes.is_short) return "the file ends within a tile";
    if (Problem problem = ReadTile(data, tiles.emplace_back())) return problem;
    const dtMeshHeader& h = tiles.back().header;
    if (h.x < 0 || h.y < 0 || h.x > kMostTiles || h.y > kMostTiles || h.layer < 0)
      return "a tile has no place in the grid";
  }
  return nullptr;
}

}  // namespace

Result<DetourMesh> ReadHabitatTiles(std::string_view file, const std::string& where) {
  Bytes bytes(file);
  const auto magic = bytes.Take<std::int32_t>();
  const auto version = bytes.Take<std::int32_t>();
  const auto count = bytes.Take<std::int32_t>();
  auto params = bytes.Take<dtNavMeshParams>();
  if (bytes.is_short || magic != kHabitatMagic)
    return Fail(ErrorCode::kMalformed, "is no navmesh of habitat-sim", where);
  if (version != kHabitatVersion || count < 1 || count > kMostTiles)
    return Fail(ErrorCode::kMalformed, "has another version, or no tiles", where);
  const float sizes[] = {params.orig[0], params.orig[1], params.orig[2], params.tileWidth,
                         params.tileHeight};
  if (!ArePlaces(sizes) || !(params.tileWidth > 0.01F) || !(params.tileHeight > 0.01F))
    return Fail(ErrorCode::kMalformed, "has tiles of no size", where);
  std::vector<Tile> tiles;
  if (Problem problem = ReadTiles(bytes, count, tiles))
    return Fail(ErrorCode::kMalformed, problem, where);
  int rows = 0, most_polys = 1;
  for (const Tile& tile : tiles) {
    rows = std::max(rows, tile.header.y + 1);
    most_polys = std::max(most_polys, tile.header.polyCount);
  }
  const dtNavMeshParams read = params;
  params.orig[0] = -(read.orig[2] + static_cast<float>(rows) * read.tileHeight);
  params.orig[2] = read.orig[0];
  params.tileWidth = read.tileHeight;
  params.tileHeight = read.tileWidth;
  params.maxTiles = count;
  params.maxPolys = most_polys;
  DetourMesh mesh(dtAllocNavMesh());
  if (!mesh || dtStatusFailed(mesh->init(&params)))
    return Fail(ErrorCode::kMalformed, "has more tiles and polygons than Detour can name", where);
  for (const Tile& tile : tiles)
    if (Problem problem = AddTurned(tile, rows, *mesh))
      return Fail(ErrorCode::kMalformed, problem, where);
  return mesh;
}

}  // namespace crossnav::sim
