// SPDX-License-Identifier: MIT
#include "crossnav/world/surface/bake_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "crossnav/core/rng.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/world/plan/plan_walls.h"

namespace crossnav::world {
namespace {

constexpr double kReach_m = 1.2;  // chosen: occlusion reads as corners and contact shadows
constexpr double kDarkest = 0.7;  // chosen: share of bounced light that full occlusion takes
constexpr double kOffset_m = 0.004;
constexpr double kPull_m = 0.12;  // chosen: off edges that run into other solids
constexpr int kRays = 10;
constexpr int kMostLights = 10;                      // chosen: per room
constexpr double kSpill_m = 7;                       // chosen: reach of light from other rooms
constexpr double kFaint = 0.02, kFaintSpill = 0.05;  // chosen: below this no ray is cast
constexpr double kCell_m = 0.07;  // chosen: on furniture, light is constant within a cell
constexpr double kUpward = 0.2;   // chosen: floors reflect light up, to ceilings most of all
constexpr double kOutdoors = 0.9;
const std::set<std::string, std::less<>> kLamps = {"ceiling lamp", "floor lamp", "table lamp"};
const std::set<std::string, std::less<>> kShell = {"wall", "floor", "ceiling", "stairs", "window"};

/// Inputs of the light at a vertex.
struct Spot {
  Vector3d p_world = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();  ///< unit, or zero for a vertex without a face
  int instance = 0;
};

Vector3d NormalOf(const sim::TriangleMesh& mesh, std::size_t t) {
  const auto& k = mesh.triangles[t];
  const Vector3d a = mesh.vertices[k[0]].cast<double>(), b = mesh.vertices[k[1]].cast<double>(),
                 c = mesh.vertices[k[2]].cast<double>();
  return (b - a).cross(c - a);  // length: twice the area
}

/// Vertices with their mean normals, pulled towards the middle of their faces.
std::vector<Spot> SpotsOf(const sim::TriangleMesh& mesh) {
  std::vector<Spot> spots(mesh.vertices.size());
  std::vector<double> weight(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d n = NormalOf(mesh, t);
    Vector3d middle = Vector3d::Zero();
    for (auto v : mesh.triangles[t]) middle += mesh.vertices[v].cast<double>() / 3;
    for (auto v : mesh.triangles[t]) {
      spots[v].normal += n;
      spots[v].p_world += n.norm() * middle;
      spots[v].instance = mesh.triangle_instance[t];
      weight[v] += n.norm();
    }
  }
  for (std::size_t v = 0; v < spots.size(); ++v) {
    const Vector3d p = mesh.vertices[v].cast<double>();
    const double length = spots[v].normal.norm();
    spots[v].normal = length < 1e-12 ? Vector3d::Zero() : Vector3d(spots[v].normal / length);
    const Vector3d inward =
        weight[v] > 0 ? Vector3d(spots[v].p_world / weight[v] - p) : Vector3d::Zero();
    const double far_m = inward.norm();
    spots[v].p_world = far_m > 1e-9 ? Vector3d(p + inward * std::min(0.5, kPull_m / far_m)) : p;
  }
  return spots;
}

class Baker {
 public:
  Baker(const sim::Scene& scene, const HousePlan& plan, const HouseLights& lights)
      : caster_(scene), plan_(plan), lights_(lights) {
    for (int i = 0; i < kRays; ++i) {  // cosine-weighted around z
      const double r = std::sqrt((i + 0.5) / kRays), angle = i * 2.399963229728653;  // golden angle
      hemisphere_.emplace_back(r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - r * r));
    }
    for (std::size_t room = 0; room < plan.rooms.size(); ++room) {
      near_.push_back(LightsNear(static_cast<int>(room)));
    }
  }

  /// Tone of a spot, [0, 1] per channel.
  Vector3d ToneAt(const Spot& spot) const {
    const int room = RoomOf(spot.p_world + 0.05 * spot.normal);
    const auto r = static_cast<std::size_t>(std::max(room, 0));
    Vector3d sum = room < 0 ? Vector3d::Constant(kOutdoors) : lights_.bounced[r];
    sum *= (1 - kUpward * spot.normal.z()) * (1 - kDarkest * OcclusionAt(spot));
    if (room >= 0) {
      for (const Light* light : near_[r]) sum += FromLight(spot, *light, light->room == room);
    }
    const Eigen::Array3d exposed = 1 - (-2.3 * sum.array()).exp();  // chosen by eye
    return Vector3d(0.28 + 0.72 * exposed);
  }

 private:
  int RoomOf(const Vector3d& p) const {
    int level = 0;
    for (std::size_t k = 0; k < plan_.levels.size(); ++k) {
      if (plan_.levels[k].floor_m <= p.z() + 0.1) level = static_cast<int>(k);
    }
    return RoomAt(plan_, level, p.head<2>());
  }

  /// Lights of the room first, then lights of other rooms around it, nearest first.
  std::vector<const Light*> LightsNear(int room) const {
    const Room& here = plan_.rooms[static_cast<std::size_t>(room)];
    const Vector2d c = here.rects[0].Center();
    const double z = plan_.levels[static_cast<std::size_t>(here.level)].floor_m + 1.2;
    std::vector<std::pair<double, const Light*>> order;
    for (const Light& light : lights_.lights) {
      const double far_m = (light.p_world - Vector3d(c.x(), c.y(), z)).norm();
      if (light.room == room) {
        order.emplace_back(far_m - 1000, &light);
      } else if (far_m < kSpill_m) {
        order.emplace_back(far_m, &light);
      }
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const Light*> nearest;
    for (const auto& [far_m, light] : order) {
      if (nearest.size() < kMostLights) nearest.push_back(light);
    }
    return nearest;
  }

  /// Share of the surroundings that is close. Imported faces have either winding: a spot that faces
  /// into its own solid is evaluated from the other side.
  double OcclusionAt(const Spot& spot) const {
    const double front = OcclusionAlong(spot.p_world, spot.normal);
    return front < 0.85 ? front : std::min(front, OcclusionAlong(spot.p_world, -spot.normal));
  }

  double OcclusionAlong(const Vector3d& p, const Vector3d& n) const {
    const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n);
    double sum = 0;
    for (const Vector3d& d : hemisphere_) {
      const auto hit = caster_.Cast(p + kOffset_m * n, turn * d, kReach_m);
      if (hit) sum += 1 - hit->distance_m / kReach_m;
    }
    return sum / kRays;
  }

  /// Light from a point of `light` to the spot without occlusion.
  static double Unshadowed(const Spot& spot, const Light& light, const Vector3d& p_light) {
    const Vector3d to = p_light - spot.p_world;
    const double d2 = to.squaredNorm(), d = std::sqrt(d2);
    if (d < 1e-3) return 0;
    const double cosine = std::abs(spot.normal.dot(to)) / d;
    if (!light.IsWindow()) return light.power * cosine / (d2 + 0.25);
    const double leaving = -light.inward.dot(to) / d;
    if (leaving <= 0) return 0;
    const double area_m2 = 4 * light.half_width.norm() * light.half_height.norm();
    return light.power * area_m2 * cosine * leaving / (std::numbers::pi * (d2 + 0.3));
  }

  bool IsVisible(const Spot& spot, const Vector3d& p_light) const {
    const Vector3d to = p_light - spot.p_world;
    const double side = spot.normal.dot(to) < 0 ? -1 : 1;  // lit from the side of the light
    return !caster_.Cast(spot.p_world + side * kOffset_m * spot.normal, to, to.norm() - 0.02);
  }

  Vector3d FromLight(const Spot& spot, const Light& light, bool is_same_room) const {
    const double whole = Unshadowed(spot, light, light.p_world);
    if (whole < (is_same_room ? kFaint : kFaintSpill)) return Vector3d::Zero();
    double sum = 0;
    int count = 0;
    const auto add = [&](double u, double v) {
      const Vector3d p = light.p_world + u * light.half_width + v * light.half_height;
      ++count;
      if (IsVisible(spot, p)) sum += Unshadowed(spot, light, p);
    };
    if (light.IsWindow() && whole > 0.12) {
      for (double u : {-0.55, 0.55}) {
        for (double v : {-0.55, 0.55}) add(u, v);
      }
    } else {
      add(0, 0);
    }
    return sum / count * light.colour;
  }

  sim::RayCaster caster_;
  const HousePlan& plan_;
  const HouseLights& lights_;
  std::vector<Vector3d> hemisphere_;
  std::vector<std::vector<const Light*>> near_;
};

/// Equal for spots of one object that are close together and face the same direction.
std::uint64_t CellOf(const Spot& spot) {
  std::uint64_t key = static_cast<std::uint64_t>(spot.instance);
  for (int i = 0; i < 3; ++i) {
    const auto cell = static_cast<std::int64_t>(std::floor(spot.p_world[i] / kCell_m));
    key =
        MixSeed(key, static_cast<std::uint64_t>(cell * 8 + std::lround(1.5 * spot.normal[i]) + 3));
  }
  return key;
}

Rgb8 Quantised(const Vector3d& tone) {
  const auto byte = [](double t) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)));
  };
  return {byte(tone.x()), byte(tone.y()), byte(tone.z())};
}

}  // namespace

void BakeLight(sim::Scene& scene, const HousePlan& plan, const HouseLights& lights,
               const std::set<int>& glowing) {
  sim::TriangleMesh& mesh = scene.mesh;
  std::vector<Rgb8> colours(mesh.vertices.size(), {255, 255, 255});
  std::vector<bool> is_lit(mesh.vertices.size(), false);
  std::vector<bool> is_lamp(scene.instances.size() + 1, false), is_shell(is_lamp);
  for (const auto& instance : scene.instances) {
    is_lamp[static_cast<std::size_t>(instance.id)] = kLamps.count(instance.name) > 0;
    is_shell[static_cast<std::size_t>(instance.id)] = kShell.count(instance.name) > 0;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (glowing.count(mesh.triangle_material[t]) > 0) continue;
    if (is_lamp[static_cast<std::size_t>(mesh.triangle_instance[t])]) continue;
    for (auto v : mesh.triangles[t]) is_lit[v] = true;
  }
  const std::vector<Spot> spots = SpotsOf(mesh);
  const Baker baker(scene, plan, lights);
  std::unordered_map<std::uint64_t, Rgb8> known;  // looked up only
  for (std::size_t v = 0; v < spots.size(); ++v) {
    const Spot& spot = spots[v];
    if (!is_lit[v] || spot.normal.isZero()) continue;
    if (is_shell[static_cast<std::size_t>(spot.instance)]) {
      colours[v] = Quantised(baker.ToneAt(spot));
      continue;
    }
    const auto [it, is_new] = known.try_emplace(CellOf(spot));
    if (is_new) it->second = Quantised(baker.ToneAt(spot));
    colours[v] = it->second;
  }
  mesh.vertex_colours = std::move(colours);
}

}  // namespace crossnav::world
