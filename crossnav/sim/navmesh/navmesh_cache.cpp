// SPDX-License-Identifier: MIT
// Navmesh tiles as bytes: magic, key, checksum of the rest, dtNavMeshParams, then size and data of
// each tile. Detour does not validate loaded data; the checksum therefore guards it.
#include <cstring>

#include <recastnavigation/DetourAlloc.h>
#include <xxhash.h>

#include "crossnav/sim/navmesh/navmesh_detail.h"

namespace crossnav::sim {
namespace {

constexpr char kCacheMagic[8] = {'c', 'n', 'a', 'v', 'm', 's', 'h', '2'};

struct Head {
  char magic[8];
  std::uint64_t key;
  std::uint64_t checksum;
};

void Append(std::vector<std::uint8_t>& out, const void* bytes, std::size_t size) {
  out.resize(out.size() + size);
  std::memcpy(out.data() + out.size() - size, bytes, size);
}

}  // namespace

std::vector<std::uint8_t> SaveTiles(const dtNavMesh& mesh, std::uint64_t key) {
  std::vector<std::uint8_t> body;
  Append(body, mesh.getParams(), sizeof(dtNavMeshParams));
  for (int i = 0; i < mesh.getMaxTiles(); ++i) {
    const dtMeshTile* tile = mesh.getTile(i);
    if (tile == nullptr || tile->header == nullptr || tile->dataSize <= 0) continue;
    // Links hold references that are made anew when the tile is added: blank them, so that equal
    // meshes have equal bytes.
    std::vector<std::uint8_t> data(tile->data, tile->data + tile->dataSize);
    const auto links = reinterpret_cast<const std::uint8_t*>(tile->links) - tile->data;
    std::memset(data.data() + links, 0,
                static_cast<std::size_t>(tile->header->maxLinkCount) * sizeof(dtLink));
    const auto polys = reinterpret_cast<const std::uint8_t*>(tile->polys) - tile->data;
    for (int p = 0; p < tile->header->polyCount; ++p) {
      dtPoly poly;
      std::uint8_t* at = data.data() + polys + static_cast<std::size_t>(p) * sizeof(dtPoly);
      std::memcpy(&poly, at, sizeof(poly));
      poly.firstLink = DT_NULL_LINK;
      std::memcpy(at, &poly, sizeof(poly));
    }
    const std::int32_t size = tile->dataSize;
    Append(body, &size, sizeof(size));
    Append(body, data.data(), data.size());
  }
  Head head{};
  std::memcpy(head.magic, kCacheMagic, sizeof(kCacheMagic));
  head.key = key;
  head.checksum = XXH3_64bits(body.data(), body.size());
  std::vector<std::uint8_t> out;
  Append(out, &head, sizeof(head));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

DetourMesh LoadTiles(const std::vector<std::uint8_t>& bytes, std::uint64_t key) {
  Head head{};
  dtNavMeshParams params{};
  if (bytes.size() < sizeof(head) + sizeof(params)) return nullptr;
  std::memcpy(&head, bytes.data(), sizeof(head));
  const std::uint8_t* body = bytes.data() + sizeof(head);
  std::size_t left = bytes.size() - sizeof(head);
  if (std::memcmp(head.magic, kCacheMagic, sizeof(kCacheMagic)) != 0 || head.key != key ||
      head.checksum != XXH3_64bits(body, left)) {
    return nullptr;
  }
  std::memcpy(&params, body, sizeof(params));
  body += sizeof(params);
  left -= sizeof(params);
  DetourMesh mesh(dtAllocNavMesh());
  if (!mesh || dtStatusFailed(mesh->init(&params))) return nullptr;
  while (left > 0) {
    std::int32_t size = 0;
    if (left < sizeof(size)) return nullptr;
    std::memcpy(&size, body, sizeof(size));
    body += sizeof(size);
    left -= sizeof(size);
    if (size <= 0 || static_cast<std::size_t>(size) > left) return nullptr;
    auto* data =
        static_cast<unsigned char*>(dtAlloc(static_cast<std::size_t>(size), DT_ALLOC_PERM));
    if (data == nullptr) return nullptr;
    std::memcpy(data, body, static_cast<std::size_t>(size));
    if (dtStatusFailed(mesh->addTile(data, size, DT_TILE_FREE_DATA, 0, nullptr))) {
      dtFree(data);
      return nullptr;
    }
    body += size;
    left -= static_cast<std::size_t>(size);
  }
  return mesh;
}

}  // namespace crossnav::sim
