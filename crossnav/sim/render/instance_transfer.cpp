// SPDX-License-Identifier: MIT
// From a coloured semantic mesh to instance ids on the rendered mesh.
#include <algorithm>
#include <cmath>
#include <map>

#include "crossnav/core/check.h"
#include "crossnav/sim/render/embree_shim.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene_reader.h"

namespace crossnav::sim {
namespace {

std::uint32_t ToHex(const Rgb8& c) {
  return static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 | c.b;
}

/// Texel nearest to (u, v); the texture repeats.
Rgb8 NearestTexel(const Texture& texture, float u, float v) {
  const auto pick = [](float x, int size) {
    return std::min(static_cast<int>((x - std::floor(x)) * static_cast<float>(size)), size - 1);
  };
  return texture.rgb.At(pick(u, texture.rgb.width), pick(v, texture.rgb.height));
}

// A triangle's corners, quantised to 0.1 mm and sorted, so that equal triangles have equal keys.
constexpr double kQuantum_m = 1e-4;
using TriangleKey = std::array<std::array<std::int32_t, 3>, 3>;

TriangleKey KeyOf(const TriangleMesh& mesh, std::size_t t) {
  TriangleKey key;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3f& v = mesh.vertices[mesh.triangles[t][k]];
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = std::clamp(v[axis] / kQuantum_m, -2e9, 2e9);
      key[k][static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(std::floor(cells + 0.5));
    }
  }
  std::sort(key.begin(), key.end());
  return key;
}

/// Sorted (key, instance); among equal triangles the first in the file wins.
std::vector<std::pair<TriangleKey, std::int32_t>> IndexTriangles(const TriangleMesh& mesh) {
  std::vector<std::pair<TriangleKey, std::int32_t>> index(mesh.triangles.size());
  for (std::size_t t = 0; t < index.size(); ++t) {
    index[t] = {KeyOf(mesh, t), mesh.triangle_instance[t]};
  }
  std::stable_sort(index.begin(), index.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return index;
}

/// Point of triangle (a, b, c) nearest to p (by Voronoi regions of corners, edges and face).
Vector3f ClosestPointOnTriangle(const Vector3f& p, const Vector3f& a, const Vector3f& b,
                                const Vector3f& c) {
  const Vector3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3f bp = p - b;
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / std::max(d1 - d3, 1e-30F));
  const Vector3f cp = p - c;
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / std::max(d2 - d6, 1e-30F));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + (c - b) * ((d4 - d3) / std::max((d4 - d3) + (d5 - d6), 1e-30F));
  }
  const float denominator = std::max(va + vb + vc, 1e-30F);
  return a + ab * (vb / denominator) + ac * (vc / denominator);
}

struct NearestSearch {
  const TriangleMesh* mesh;
  std::int64_t triangle = -1;
};

bool KeepNearest(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearestSearch*>(arguments->userPtr);
  const auto& corners = search.mesh->triangles[arguments->primID];
  const auto& v = search.mesh->vertices;
  const Vector3f p(arguments->query->x, arguments->query->y, arguments->query->z);
  const Vector3f q = ClosestPointOnTriangle(p, v[corners[0]], v[corners[1]], v[corners[2]]);
  const float distance = (q - p).norm();
  // Equal distances: the lower index wins, so that the order of visits does not matter.
  const bool tie = distance == arguments->query->radius && search.triangle >= 0 &&
                   arguments->primID < search.triangle;
  if (distance < arguments->query->radius || tie) {
    arguments->query->radius = distance;
    search.triangle = arguments->primID;
    return true;
  }
  return false;
}

EmbreeScene MakeQueryScene(RTCDevice device, const TriangleMesh& mesh) {
  EmbreeScene scene(rtcNewScene(device));
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  auto* triangles = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  CROSSNAV_CHECK(vertices != nullptr && triangles != nullptr, "out of memory for the ray index");
  for (const Vector3f& v : mesh.vertices) vertices = std::copy_n(v.data(), 3, vertices);
  for (const auto& t : mesh.triangles) triangles = std::copy_n(t.data(), 3, triangles);
  rtcSetGeometryPointQueryFunction(geometry, KeepNearest);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  Commit(scene.get());
  return scene;
}

std::int64_t NearestTriangle(RTCScene scene, const TriangleMesh& mesh, const Vector3f& p,
                             double max_m) {
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{};
  query.x = p.x();
  query.y = p.y();
  query.z = p.z();
  query.radius = static_cast<float>(max_m);
  NearestSearch search{&mesh};
  rtcPointQuery(scene, &query, &context, nullptr, &search);
  return search.triangle;
}

}  // namespace

std::vector<std::int32_t> InstancesByColour(const GltfModel& semantic,
                                            std::span<const SemanticLine> lines) {
  std::map<std::uint32_t, std::int32_t> id_of_colour;
  for (const SemanticLine& line : lines) id_of_colour.emplace(line.colour, line.id);
  const TriangleMesh& mesh = semantic.mesh;
  // Barycentric places to look at: the centre, then nearer to each corner (a triangle may cross the
  // border between two colours of the texture).
  constexpr std::array<std::array<float, 3>, 4> kPlaces{
      {{1 / 3.0F, 1 / 3.0F, 1 / 3.0F}, {0.6F, 0.2F, 0.2F}, {0.2F, 0.6F, 0.2F}, {0.2F, 0.2F, 0.6F}}};
  const auto colour_at = [&](std::size_t t, std::size_t place) {
    const auto& corner = mesh.triangles[t];
    const Material& material = semantic.materials[mesh.triangle_material[t]];
    if (material.texture >= 0 && !mesh.uvs.empty()) {
      float u = 0, v = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        u += kPlaces[place][k] * mesh.uvs[corner[k]][0];
        v += kPlaces[place][k] * mesh.uvs[corner[k]][1];
      }
      return NearestTexel(semantic.textures[static_cast<std::size_t>(material.texture)], u, v);
    }
    if (!mesh.vertex_colours.empty())
      return mesh.vertex_colours[corner[place == 0 ? 0 : place - 1]];
    return material.colour;
  };
  std::vector<std::int32_t> instance(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < instance.size(); ++t) {
    for (std::size_t place = 0; place < kPlaces.size() && instance[t] == 0; ++place) {
      const auto found = id_of_colour.find(ToHex(colour_at(t, place)));
      if (found != id_of_colour.end()) instance[t] = found->second;
    }
  }
  return instance;
}

std::vector<std::int32_t> TransferInstances(const TriangleMesh& source, const TriangleMesh& target,
                                            double max_m) {
  const auto index = IndexTriangles(source);
  EmbreeDevice device;
  EmbreeScene scene;
  std::vector<std::int32_t> instance(target.triangles.size(), 0);
  for (std::size_t t = 0; t < instance.size(); ++t) {
    const TriangleKey key = KeyOf(target, t);
    const auto found =
        std::lower_bound(index.begin(), index.end(), key,
                         [](const auto& a, const TriangleKey& k) { return a.first < k; });
    if (found != index.end() && found->first == key) {
      instance[t] = found->second;
      continue;
    }
    if (!scene) {  // built only where the meshes differ
      device.reset(rtcNewDevice(EmbreeConfig(kInstructions).c_str()));
      CROSSNAV_CHECK(device != nullptr, "Embree gives no device");
      scene = MakeQueryScene(device.get(), source);
    }
    const auto& corner = target.triangles[t];
    const Vector3f centre =
        (target.vertices[corner[0]] + target.vertices[corner[1]] + target.vertices[corner[2]]) /
        3.0F;
    const std::int64_t nearest = NearestTriangle(scene.get(), source, centre, max_m);
    if (nearest >= 0) instance[t] = source.triangle_instance[static_cast<std::size_t>(nearest)];
  }
  return instance;
}

}  // namespace crossnav::sim
