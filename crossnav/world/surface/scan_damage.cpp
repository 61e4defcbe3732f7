// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/scan_damage.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "crossnav/core/rng.h"
#include "crossnav/world/mesh/subdivide.h"

namespace crossnav::world {
namespace {

constexpr double kBehindMirror_m = 0.2;  // chosen: a wall and its other face
constexpr double kNearCeiling_m = 0.7;   // chosen: objects that end above this are hard to scan
constexpr double kNoTop_m = 1e9;
constexpr double kNoisyEdge_m = 0.4, kNoisyArea_m2 = 0.02;  // chosen: surfaces come out uneven
constexpr double kFineEdge_m = 0.12;                        // chosen: borders come out ragged
constexpr Rgb8 kUnseen{28, 28, 30};                         // scanners leave unseen surfaces black
constexpr double kFragment_m = 0.06;
constexpr double kOverHead_m = 1.6;  // fragments float above head height

Vector3d Normal2(const sim::TriangleMesh& mesh, std::size_t t) {
  const auto& k = mesh.triangles[t];
  const Vector3d a = mesh.vertices[k[0]].cast<double>(), b = mesh.vertices[k[1]].cast<double>(),
                 c = mesh.vertices[k[2]].cast<double>();
  return (b - a).cross(c - a);  // length: twice the area
}

Vector3d MiddleOf(const sim::TriangleMesh& mesh, std::size_t t) {
  Vector3d c = Vector3d::Zero();
  for (auto v : mesh.triangles[t]) c += mesh.vertices[v].cast<double>() / 3;
  return c;
}

/// Walkable ground or similar surfaces.
bool IsGround(const sim::TriangleMesh& mesh, std::size_t t) {
  const Vector3d n = Normal2(mesh, t);
  return n.z() > 0.7 * n.norm();
}

Box3 BoxOf(const sim::TriangleMesh& mesh, std::size_t t) {
  Box3 box;
  for (auto v : mesh.triangles[t]) box.Add(mesh.vertices[v].cast<double>());
  return box;
}

bool Meet(const Box3& a, const Box3& b) {
  return (a.max.array() >= b.min.array()).all() && (b.max.array() >= a.min.array()).all();
}

template <class IsGone>
void RemoveTriangles(sim::TriangleMesh& mesh, IsGone is_gone) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_gone(t)) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.triangle_material[kept] = mesh.triangle_material[t];
    mesh.triangle_instance[kept++] = mesh.triangle_instance[t];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_material.resize(kept);
  mesh.triangle_instance.resize(kept);
}

/// Places on surfaces, evenly by area, sorted by x, with a search for neighbours.
class Places {
 public:
  Places(const sim::TriangleMesh& mesh, double per_m2, double radius_m, Rng rng)
      : radius_m_(radius_m) {
    std::vector<double> up_to;  // area of the triangles so far
    double area_m2 = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      up_to.push_back(area_m2 += 0.5 * Normal2(mesh, t).norm());
    }
    const auto count = static_cast<std::size_t>(per_m2 * area_m2);
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = std::lower_bound(up_to.begin(), up_to.end(), rng.Uniform(0, area_m2));
      const auto t = static_cast<std::size_t>(at - up_to.begin());
      places_.push_back(PointOn(mesh, std::min(t, mesh.triangles.size() - 1), rng));
    }
    std::sort(places_.begin(), places_.end(),
              [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); });
  }

  bool Cover(const Vector3d& p) const { return Touch({p, p}); }

  /// True if a place is within the radius of the box.
  bool Touch(const Box3& box) const {
    auto it = std::lower_bound(places_.begin(), places_.end(), box.min.x() - radius_m_,
                               [](const Vector3d& a, double x) { return a.x() < x; });
    for (; it != places_.end() && it->x() < box.max.x() + radius_m_; ++it) {
      const Vector3d nearest = it->cwiseMax(box.min).cwiseMin(box.max);
      if ((*it - nearest).norm() < radius_m_) return true;
    }
    return false;
  }

 private:
  static Vector3d PointOn(const sim::TriangleMesh& mesh, std::size_t t, Rng& rng) {
    const auto& k = mesh.triangles[t];
    double u = rng.Uniform(), v = rng.Uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return (1 - u - v) * mesh.vertices[k[0]].cast<double>() +
           u * mesh.vertices[k[1]].cast<double>() + v * mesh.vertices[k[2]].cast<double>();
  }

  double radius_m_;
  std::vector<Vector3d> places_;
};

/// Material that covers most of an instance: the glass of a window.
std::uint16_t PaneOf(const sim::TriangleMesh& mesh, int instance) {
  std::map<std::uint16_t, double> area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] == instance) {
      area[mesh.triangle_material[t]] += Normal2(mesh, t).norm();
    }
  }
  const auto most = std::max_element(
      area.begin(), area.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == area.end() ? std::uint16_t{0} : most->first;
}

/// Panes and mirrors that a scanner sees through.
struct LostGlass {
  std::map<int, std::uint16_t> panes;  ///< material, for windows that lose their pane
  std::vector<Box3> mirrors;           ///< removed, the wall behind included
};

LostGlass DrawLostGlass(const sim::Scene& scene, const ScanDamage& damage, Rng rng) {
  LostGlass lost;
  for (const auto& instance : scene.instances) {
    const bool is_mirror = instance.name == "mirror";
    if (!is_mirror && instance.name != "window") continue;
    if (!rng.Chance(is_mirror ? damage.mirror_share : damage.glass_share)) continue;
    if (!is_mirror) {
      lost.panes[instance.id] = PaneOf(scene.mesh, instance.id);
      continue;
    }
    Box3 box = instance.box;
    const int thin = box.max.x() - box.min.x() < box.max.y() - box.min.y() ? 0 : 1;
    box.min[thin] -= kBehindMirror_m;
    box.max[thin] += kBehindMirror_m;
    lost.mirrors.push_back(box);
  }
  return lost;
}

/// Height of the ceiling over the box, if its top is near a ceiling.
std::optional<double> CeilingOver(const sim::Scene& scene, const Box3& box) {
  for (const auto& other : scene.instances) {
    if (other.name != "ceiling") continue;
    const double under_m = other.box.min.z() - box.max.z();
    const Vector3d c = box.Center();
    const bool is_over = c.x() >= other.box.min.x() && c.x() <= other.box.max.x() &&
                         c.y() >= other.box.min.y() && c.y() <= other.box.max.y();
    if (is_over && under_m > -0.05 && under_m < kNearCeiling_m) return other.box.min.z();
  }
  return std::nullopt;
}

/// Per instance, the height above which it is removed.
std::vector<double> DrawTops(const sim::Scene& scene, const ScanDamage& damage, Rng rng) {
  static const std::set<std::string, std::less<>> kWhole = {"wall",    "ceiling", "floor", "stairs",
                                                            "railing", "window",  "mirror"};
  std::vector<double> tops(scene.instances.size() + 1, kNoTop_m);
  for (const auto& instance : scene.instances) {
    if (kWhole.count(instance.name) > 0) continue;
    const auto ceiling_m = CeilingOver(scene, instance.box);
    if (!ceiling_m || !rng.Chance(damage.cut_share)) continue;
    tops[static_cast<std::size_t>(instance.id)] = *ceiling_m - rng.Uniform(0.25, 0.6);
  }
  return tops;
}

void AddNoise(sim::TriangleMesh& mesh, const ScanDamage& damage) {
  // The same place moves by the same offset, or cracks would open between faces.
  for (auto& v : mesh.vertices) {
    std::uint64_t key = damage.seed;
    for (int i = 0; i < 3; ++i) {
      key = MixSeed(key, static_cast<std::uint64_t>(std::llround(v[i] * 1000.0F) + 1000000));
    }
    Rng place(key);
    for (const int axis : {2, 1, 0}) {
      v[axis] += static_cast<float>(place.Normal()) * static_cast<float>(damage.noise_m);
    }
  }
}

void AddFragments(sim::Scene& scene, const ScanDamage& damage, Rng rng) {
  sim::TriangleMesh& mesh = scene.mesh;
  Box3 box;
  for (const auto& v : mesh.vertices) box.Add(v.cast<double>());
  for (int i = 0; i < damage.floaters; ++i) {
    Vector3d c, low = box.min + kOverHead_m * Vector3d::UnitZ();
    for (const int axis : {2, 1, 0}) c[axis] = rng.Uniform(low[axis], box.max[axis]);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      Vector3d off;
      for (const int axis : {2, 1, 0}) off[axis] = rng.Normal();
      const Vector3d p = c + kFragment_m * off;
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

/// Boxes of the remaining geometry; a fully removed instance keeps its place with zero extent.
void UpdateBoxes(sim::Scene& scene) {
  std::vector<Box3> boxes(scene.instances.size() + 1);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    Box3& box = boxes[static_cast<std::size_t>(scene.mesh.triangle_instance[t])];
    for (auto v : scene.mesh.triangles[t]) box.Add(scene.mesh.vertices[v].cast<double>());
  }
  for (auto& instance : scene.instances) {
    const Box3& left = boxes[static_cast<std::size_t>(instance.id)];
    if (!left.empty()) instance.box = left;
  }
}

}  // namespace

void DamageAsScan(sim::Scene& scene, const ScanDamage& damage) {
  // One random stream per fault, so that switching a fault off does not change the others.
  const auto stream = [&](std::uint64_t fault) { return Rng(damage.seed, 77 + fault); };
  sim::TriangleMesh& mesh = scene.mesh;
  const LostGlass lost = DrawLostGlass(scene, damage, stream(0));
  const std::vector<double> tops = DrawTops(scene, damage, stream(1));
  const Places holes(mesh, damage.holes_per_m2, damage.hole_radius_m, stream(2));
  const Places blanks(mesh, damage.blanks_per_m2, damage.blank_radius_m, stream(3));
  const auto top_of = [&](std::size_t t) {
    return tops[static_cast<std::size_t>(mesh.triangle_instance[t])];
  };
  // behind a mirror, or a mirror itself
  std::vector<bool> is_behind(scene.instances.size() + 1, false);
  for (const auto& i : scene.instances) {
    is_behind[static_cast<std::size_t>(i.id)] = i.name == "wall" || i.name == "mirror";
  }
  const auto is_mirror = [&](std::size_t t, const Box3& box) {
    return is_behind[static_cast<std::size_t>(mesh.triangle_instance[t])] &&
           std::any_of(lost.mirrors.begin(), lost.mirrors.end(),
                       [&](const Box3& b) { return Meet(b, box); });
  };

  Subdivide(mesh, kNoisyEdge_m, kNoisyArea_m2);
  SubdivideWhere(mesh, kFineEdge_m, [&](std::size_t t) {
    const Box3 box = BoxOf(mesh, t);
    return holes.Touch(box) || blanks.Touch(box) || is_mirror(t, box) ||
           (box.min.z() < top_of(t) && box.max.z() > top_of(t));
  });
  RemoveTriangles(mesh, [&](std::size_t t) {
    const Vector3d p = MiddleOf(mesh, t);
    const auto pane = lost.panes.find(mesh.triangle_instance[t]);
    const bool is_pane = pane != lost.panes.end() && pane->second == mesh.triangle_material[t];
    return is_pane || is_mirror(t, {p, p}) || p.z() > top_of(t) ||
           (holes.Cover(p) && !IsGround(mesh, t));
  });
  const auto blank = static_cast<std::uint16_t>(scene.materials.size());
  scene.materials.push_back({kUnseen, -1});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (blanks.Cover(MiddleOf(mesh, t))) mesh.triangle_material[t] = blank;
  }
  AddNoise(mesh, damage);
  AddFragments(scene, damage, stream(4));
  UpdateBoxes(scene);
}

}  // namespace crossnav::world
