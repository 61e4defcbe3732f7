// SPDX-License-Identifier: MIT
#include "crossnav/sim/navmesh/habitat_navmesh.h"
#include "crossnav/sim/navmesh/navmesh_detail.h"

namespace crossnav::sim {
namespace {

template <class T>
void Append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// The scene turned so that Recast's frame of it is Habitat's frame of the scene.
Scene TurnedForHabitat(const Scene& scene) {
  Scene turned;
  turned.id = scene.id;
  turned.mesh.vertices.reserve(scene.mesh.vertices.size());
  for (const Vector3f& p : scene.mesh.vertices) {
    turned.mesh.vertices.emplace_back(-p.y(), p.x(), p.z());
  }
  turned.mesh.triangles = scene.mesh.triangles;
  turned.mesh.triangle_instance = scene.mesh.triangle_instance;
  turned.instances = scene.instances;
  UpdateDerived(turned);
  return turned;
}

}  // namespace

Result<std::string> EncodeHabitatNavMesh(const Scene& scene, const NavMeshSettings& settings) {
  static_assert(sizeof(dtTileRef) == 4, "habitat-sim's Detour has 32-bit references");
  const auto mesh = BuildDetour(TurnedForHabitat(scene), settings);
  if (!mesh) return tl::unexpected(mesh.error());
  const dtNavMesh& tiles = **mesh;
  std::int32_t count = 0;
  while (count < tiles.getMaxTiles() && tiles.getTile(count)->header != nullptr) ++count;
  // habitat-sim looks into every tile that the file announces: there must be no empty ones.
  dtNavMeshParams params = *tiles.getParams();
  params.maxTiles = count;
  DetourMesh exact(dtAllocNavMesh());
  if (count == 0 || !exact || dtStatusFailed(exact->init(&params))) {
    return Fail(ErrorCode::kInvalid, "no walkable ground was found", scene.id);
  }
  std::string out;
  Append(out, kHabitatMagic);
  Append(out, kHabitatVersion);
  Append(out, count);
  Append(out, params);
  for (int i = 0; i < count; ++i) {
    const dtMeshTile* tile = tiles.getTile(i);
    Append(out, exact->encodePolyId(1, static_cast<unsigned>(i), 0));
    Append(out, static_cast<std::int32_t>(tile->dataSize));
    out.append(reinterpret_cast<const char*>(tile->data), static_cast<std::size_t>(tile->dataSize));
  }
  return out;
}

}  // namespace crossnav::sim
