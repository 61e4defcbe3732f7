// SPDX-License-Identifier: MIT
#include "crossnav/world/finish_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "crossnav/core/rng.h"
#include "crossnav/sim/ray_caster.h"

namespace crossnav::world {
namespace {

constexpr double kReach_m = 1.2;   // chosen: occlusion reads as corners and contact shadows
constexpr double kDarkest = 0.45;  // chosen: share of light that full occlusion takes
constexpr double kOffset_m = 0.004;
constexpr int kRays = 10;

Vector3d NormalOf(const sim::TriangleMesh& mesh, std::size_t t) {
  const auto& k = mesh.triangles[t];
  const Vector3d a = mesh.vertices[k[0]].cast<double>(), b = mesh.vertices[k[1]].cast<double>(),
                 c = mesh.vertices[k[2]].cast<double>();
  return (b - a).cross(c - a);  // twice the area long
}

/// Cosine-weighted directions around z, the same for every vertex.
std::vector<Vector3d> Hemisphere() {
  std::vector<Vector3d> directions;
  for (int i = 0; i < kRays; ++i) {
    const double r = std::sqrt((i + 0.5) / kRays), angle = i * 2.399963229728653;  // golden angle
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - r * r));
  }
  return directions;
}

/// Share of light taken from a point with unit normal `n`.
double Occlusion(const sim::RayCaster& caster, const Vector3d& p, const Vector3d& n,
                 const std::vector<Vector3d>& directions) {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n);
  double sum = 0;
  for (const Vector3d& d : directions) {
    const auto hit = caster.Cast(p + kOffset_m * n, turn * d, kReach_m);
    if (hit) sum += 1 - hit->distance_m / kReach_m;
  }
  return sum / static_cast<double>(directions.size());
}

}  // namespace

void Subdivide(sim::TriangleMesh& mesh, double max_edge_m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;  // of edges
  for (std::size_t t = 0; t < mesh.triangles.size();) {
    const auto k = mesh.triangles[t];
    int longest = 0;
    float longest_m = -1;
    for (int e = 0; e < 3; ++e) {
      const float m = (mesh.vertices[k[static_cast<std::size_t>(e)]] -
                       mesh.vertices[k[static_cast<std::size_t>((e + 1) % 3)]])
                          .norm();
      if (m > longest_m) {
        longest_m = m;
        longest = e;
      }
    }
    if (longest_m <= static_cast<float>(max_edge_m)) {
      ++t;
      continue;
    }
    const auto a = k[static_cast<std::size_t>(longest)];
    const auto b = k[static_cast<std::size_t>((longest + 1) % 3)];
    const auto c = k[static_cast<std::size_t>((longest + 2) % 3)];
    const auto [it, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                  static_cast<std::uint32_t>(mesh.vertices.size()));
    const std::uint32_t mid = it->second;
    if (is_new) {
      const Vector3f p = 0.5F * (mesh.vertices[a] + mesh.vertices[b]);
      mesh.vertices.push_back(p);
    }
    if (is_new && !mesh.uvs.empty()) {
      const std::array<float, 2> uv = {0.5F * (mesh.uvs[a][0] + mesh.uvs[b][0]),
                                       0.5F * (mesh.uvs[a][1] + mesh.uvs[b][1])};
      mesh.uvs.push_back(uv);
    }
    mesh.triangles[t] = {a, mid, c};
    mesh.triangles.push_back({mid, b, c});
    mesh.triangle_material.push_back(std::uint16_t{mesh.triangle_material[t]});
    mesh.triangle_instance.push_back(std::int32_t{mesh.triangle_instance[t]});
  }
}

void BakeAmbientOcclusion(sim::Scene& scene) {
  sim::TriangleMesh& mesh = scene.mesh;
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d n = NormalOf(mesh, t);
    for (auto v : mesh.triangles[t]) normals[v] += n;
  }
  const sim::RayCaster caster(scene);
  const auto directions = Hemisphere();
  std::vector<Rgb8> colours(mesh.vertices.size(), {255, 255, 255});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double length = normals[v].norm();
    if (length < 1e-12) continue;
    const double dark =
        Occlusion(caster, mesh.vertices[v].cast<double>(), normals[v] / length, directions);
    const auto tone = static_cast<std::uint8_t>(std::lround(255 * (1 - kDarkest * dark)));
    colours[v] = {tone, tone, tone};
  }
  mesh.vertex_colours = std::move(colours);
}

void DamageAsScan(sim::Scene& scene, const ScanDamage& damage) {
  sim::TriangleMesh& mesh = scene.mesh;
  Rng rng(damage.seed, 77);
  Subdivide(mesh, damage.hole_radius_m);
  double area_m2 = 0;
  Box3 box;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area_m2 += 0.5 * NormalOf(mesh, t).norm();
  for (const auto& v : mesh.vertices) box.Add(v.cast<double>());
  std::vector<Vector3d> holes;
  const auto count = static_cast<std::size_t>(damage.holes_per_m2 * area_m2);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = rng.Below(static_cast<std::uint32_t>(mesh.triangles.size()));
    holes.push_back(mesh.vertices[mesh.triangles[t][0]].cast<double>());
  }
  std::sort(holes.begin(), holes.end(),
            [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); });
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vector3d c = Vector3d::Zero();
    for (auto v : mesh.triangles[t]) c += mesh.vertices[v].cast<double>() / 3;
    const Vector3d n = NormalOf(mesh, t);
    const bool is_ground = n.z() > 0.7 * n.norm();  // one must still be able to walk
    bool is_hole = false;
    auto it = std::lower_bound(holes.begin(), holes.end(), c.x() - damage.hole_radius_m,
                               [](const Vector3d& h, double x) { return h.x() < x; });
    for (; !is_ground && it != holes.end() && it->x() < c.x() + damage.hole_radius_m; ++it) {
      is_hole = is_hole || (*it - c).norm() < damage.hole_radius_m;
    }
    if (is_hole) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.triangle_material[kept] = mesh.triangle_material[t];
    mesh.triangle_instance[kept++] = mesh.triangle_instance[t];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_material.resize(kept);
  mesh.triangle_instance.resize(kept);
  // The same place moves the same way, or cracks would open between faces.
  for (auto& v : mesh.vertices) {
    std::uint64_t key = damage.seed;
    for (int i = 0; i < 3; ++i) {
      key = MixSeed(key, static_cast<std::uint64_t>(std::llround(v[i] * 1000.0F) + 1000000));
    }
    Rng place(key);
    v += Vector3f(static_cast<float>(place.Normal()), static_cast<float>(place.Normal()),
                  static_cast<float>(place.Normal())) *
         static_cast<float>(damage.noise_m);
  }
  for (int i = 0; i < damage.floaters; ++i) {
    const Vector3d c(rng.Uniform(box.min.x(), box.max.x()), rng.Uniform(box.min.y(), box.max.y()),
                     rng.Uniform(box.min.z() + 1.6, box.max.z()));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      const Vector3d p = c + 0.06 * Vector3d(rng.Normal(), rng.Normal(), rng.Normal());
      mesh.vertices.push_back(p.cast<float>());
      if (!mesh.uvs.empty()) mesh.uvs.push_back({0, 0});
      if (!mesh.vertex_colours.empty()) mesh.vertex_colours.push_back({255, 255, 255});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangle_material.push_back(
        static_cast<std::uint16_t>(rng.Below(static_cast<std::uint32_t>(scene.materials.size()))));
    mesh.triangle_instance.push_back(0);
  }
}

}  // namespace crossnav::world
