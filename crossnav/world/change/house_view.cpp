// SPDX-License-Identifier: MIT
#include "crossnav/world/change/house_view.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/world/change/object_words.h"

namespace crossnav::world {
namespace {

constexpr double kBeside_m = 0.7;         // chosen: a chair belongs to the table at arm's length
constexpr double kLayer_m = 0.12;         // chosen: rugs and navmesh heights above the floor itself
constexpr double kContact_m = 0.06;       // chosen: gaps below feet in scans
constexpr double kChain_m = 1.6;          // chosen: from the underside of the highest shelf's load
constexpr double kLandmarkSide_m = 0.35;  // chosen: narrower pieces are no landmarks

const sim::SceneInstance* NamedAt(const sim::Scene& scene, int id) {
  return id > 0 ? scene.FindInstance(id) : nullptr;
}

/// Floor's instance at or a little below `p_world`.
const sim::SceneInstance* GroundAt(const sim::Scene& scene, const sim::RayCaster& caster,
                                   const Vector3d& p_world) {
  const auto hit = caster.Cast(p_world + Vector3d(0, 0, 0.2), -Vector3d::UnitZ(), 0.2 + kLayer_m);
  const auto* instance = hit ? NamedAt(scene, hit->instance) : nullptr;
  return instance != nullptr && IsGround(instance->name) ? instance : nullptr;
}

/// Grid points of the navmesh with the ground under them.
struct GroundPoint {
  Vector3d p_world;
  int region = 0;
};

std::vector<GroundPoint> GroundPoints(const sim::Scene& scene, const sim::RayCaster& caster,
                                      const sim::NavMesh& navmesh) {
  Box3 box;
  for (const auto& triangle : navmesh.Triangles()) {
    for (const Vector3f& p : triangle.p_world) box.Add(p.cast<double>());
  }
  std::vector<GroundPoint> points;
  if (box.empty()) return points;
  const auto first = [](double m) { return static_cast<int>(std::ceil(m / kGroundGrid_m)); };
  for (int x = first(box.min.x()); x * kGroundGrid_m <= box.max.x(); ++x) {
    for (int y = first(box.min.y()); y * kGroundGrid_m <= box.max.y(); ++y) {
      const double x_m = x * kGroundGrid_m, y_m = y * kGroundGrid_m;
      for (const double z_m : navmesh.HeightsAt(x_m, y_m, box.min.z() - 0.1, box.max.z() + 0.1)) {
        const Vector3d p_world(x_m, y_m, z_m);
        const auto* ground = GroundAt(scene, caster, p_world);
        if (ground != nullptr) points.push_back({p_world, ground->region});
      }
    }
  }
  return points;
}

/// Of a few spread points, the point that reaches most of the others.
std::optional<Vector3d> StartOf(const std::vector<GroundPoint>& points,
                                const sim::NavMesh& navmesh) {
  constexpr std::size_t kStarts = 12, kOthers = 40;  // chosen: the largest part is most of a house
  std::optional<Vector3d> best;
  int most = 0;
  for (std::size_t i = 0; i < std::min(kStarts, points.size()); ++i) {
    const Vector3d& p = points[i * points.size() / std::min(kStarts, points.size())].p_world;
    int reached = 0;
    for (std::size_t j = 0; j < std::min(kOthers, points.size()); ++j) {
      const Vector3d& q = points[j * points.size() / std::min(kOthers, points.size())].p_world;
      reached += navmesh.Geodesic(p, q).has_value() ? 1 : 0;
    }
    if (reached <= most) continue;
    most = reached;
    best = p;
  }
  return best;
}

void AddRooms(const std::vector<GroundPoint>& points, HouseView& view) {
  std::map<std::pair<int, int>, RoomView> rooms;
  for (const GroundPoint& point : points) {
    if (!view.navmesh->Geodesic(view.start_world, point.p_world)) continue;
    const int floor = view.navmesh->FloorOf(point.p_world);
    RoomView& room = rooms[{floor, point.region}];
    room.region = point.region;
    room.floor = floor;
    room.ground.push_back(point.p_world);
  }
  for (auto& [key, room] : rooms) view.rooms.push_back(std::move(room));
}

/// Spread corners of an instance's lowest triangles: possible contacts with its support.
std::vector<Vector3d> FeetOf(const sim::Scene& scene, const sim::SceneInstance& instance) {
  std::vector<Vector3d> low;
  const sim::TriangleMesh& mesh = scene.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_instance[t] != instance.id) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vector3d p = mesh.vertices[v].cast<double>();
      if (p.z() < instance.box.min.z() + 0.01) low.push_back(p);
    }
  }
  constexpr std::size_t kFeet = 9;  // chosen: more than four legs
  std::vector<Vector3d> feet;
  const std::size_t count = std::min(kFeet, low.size());
  const Vector3d centre = instance.box.Center();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d foot = low[i * low.size() / count];
    Vector3d inwards = centre - foot;
    inwards.z() = 0;
    // Beside the foot as well: under it the two surfaces often lie in one plane.
    feet.push_back(foot + 0.1 * inwards);
    if (inwards.norm() > 1e-6) feet.push_back(foot - 0.015 * inwards.normalized());
  }
  return feet;
}

/// Instance below most of the feet; 0 = hanging.
int SupportOf(const sim::Scene& scene, const sim::RayCaster& caster,
              const sim::SceneInstance& instance) {
  std::map<int, int> votes;
  for (const Vector3d& foot : FeetOf(scene, instance)) {
    const auto hit =
        SurfaceBelow(caster, foot + Vector3d(0, 0, 0.01), instance.id, 0.01 + kContact_m);
    if (hit && hit->instance > 0) ++votes[hit->instance];
  }
  int best = 0, most = 0;
  for (const auto& [id, count] : votes) {
    if (count <= most) continue;
    best = id;
    most = count;
  }
  return best;
}

int RoomOfRegion(const HouseView& view, int region, double z_m) {
  int best = -1;
  double nearest_m = 1.5;  // chosen: half a storey
  for (std::size_t i = 0; i < view.rooms.size(); ++i) {
    if (view.rooms[i].region != region) continue;
    const double gap_m = std::abs(view.rooms[i].ground.front().z() - z_m);
    if (gap_m >= nearest_m) continue;
    nearest_m = gap_m;
    best = static_cast<int>(i);
  }
  return best;
}

/// Room of the floor below the middle of an object, despite objects between.
int RoomUnder(const sim::Scene& scene, const sim::RayCaster& caster,
              const sim::SceneInstance& instance, const HouseView& view) {
  Vector3d p = instance.box.Center();
  p.z() = instance.box.min.z() + 0.02;
  const double lowest_z = p.z() - kChain_m;
  for (int layer = 0; layer < 20 && p.z() > lowest_z; ++layer) {
    const auto hit = caster.Cast(p, -Vector3d::UnitZ(), p.z() - lowest_z);
    if (!hit) return -1;
    const auto* below = NamedAt(scene, hit->instance);
    if (below != nullptr && IsGround(below->name)) {
      return RoomOfRegion(view, below->region, hit->p_world.z());
    }
    p.z() = hit->p_world.z() - 1e-3;
  }
  return -1;
}

void AddObjects(const sim::Scene& scene, const sim::RayCaster& caster, HouseView& view) {
  for (const sim::SceneInstance& instance : scene.instances) {
    if (instance.box.empty()) continue;
    ObjectView object;
    const bool may_move = IsMovable(instance.name, instance.category);
    if (may_move || HasTop(instance.name) || IsLandmark(instance.name)) {
      object.support = SupportOf(scene, caster, instance);
      object.room = RoomUnder(scene, caster, instance, view);
      const auto* below = NamedAt(scene, object.support);
      object.is_on_ground = below != nullptr && IsGround(below->name);
      if (object.is_on_ground) object.landmark = LandmarkBeside(scene, instance.box, instance.id);
    }
    view.objects[instance.id] = object;
  }
  for (const auto& [id, object] : view.objects) {
    const auto carrier = view.objects.find(object.support);
    if (carrier != view.objects.end()) carrier->second.is_carrier = true;
  }
}

void MarkFixtures(const sim::Scene& scene, const sim::RayCaster& caster, HouseView& view) {
  for (const sim::SceneInstance& instance : scene.instances) {
    const bool is_bath = IsBathFixture(instance.name), is_kitchen = IsKitchenFixture(instance.name);
    if (instance.box.empty() || !(is_bath || is_kitchen)) continue;
    const int room = RoomUnder(scene, caster, instance, view);
    if (room < 0) continue;
    RoomView& at = view.rooms[static_cast<std::size_t>(room)];
    at.is_bath = at.is_bath || is_bath;
    at.is_kitchen = at.is_kitchen || is_kitchen;
  }
}

}  // namespace

std::optional<sim::RayHit> SurfaceBelow(const sim::RayCaster& caster, const Vector3d& p_world,
                                        int but, double max_m) {
  Vector3d from = p_world;
  double left_m = max_m;
  for (int layer = 0; layer < 32 && left_m > 0; ++layer) {
    const auto hit = caster.Cast(from, -Vector3d::UnitZ(), left_m);
    if (!hit || hit->instance != but) return hit;
    const double down_m = hit->distance_m + 1e-4;
    from.z() -= down_m;
    left_m -= down_m;
  }
  return std::nullopt;
}

double GapOf(const Box3& a, const Box3& b) {
  const double dx = std::max({a.min.x() - b.max.x(), b.min.x() - a.max.x(), 0.0});
  const double dy = std::max({a.min.y() - b.max.y(), b.min.y() - a.max.y(), 0.0});
  return std::hypot(dx, dy);
}

int LandmarkBeside(const sim::Scene& scene, const Box3& box, int but) {
  int best = 0;
  double nearest_m = kBeside_m;
  for (const sim::SceneInstance& other : scene.instances) {
    if (other.id == but || other.box.empty() || !IsLandmark(other.name)) continue;
    if (std::abs(other.box.min.z() - box.min.z()) > 0.3) continue;
    const Vector3d size = other.box.max - other.box.min;
    if (std::max(size.x(), size.y()) < kLandmarkSide_m) continue;
    const double gap_m = GapOf(box, other.box);
    if (gap_m >= nearest_m) continue;
    nearest_m = gap_m;
    best = other.id;
  }
  return best;
}

Result<HouseView> ViewHouse(const sim::Scene& scene, const sim::NavMeshSettings& settings) {
  if (scene.instances.empty()) {
    return Fail(ErrorCode::kInvalid, "has no semantic text: nothing in it can change",
                scene.folder.string());
  }
  auto navmesh = sim::NavMesh::Build(scene, settings);
  if (!navmesh) return tl::unexpected(navmesh.error());
  HouseView view;
  view.navmesh = std::make_unique<sim::NavMesh>(std::move(*navmesh));
  const sim::RayCaster caster(scene);
  const auto points = GroundPoints(scene, caster, *view.navmesh);
  const auto start = StartOf(points, *view.navmesh);
  if (!start) {
    return Fail(ErrorCode::kInvalid, "has no instance called floor that can be walked on",
                scene.folder.string());
  }
  view.start_world = *start;
  AddRooms(points, view);
  AddObjects(scene, caster, view);
  MarkFixtures(scene, caster, view);
  return view;
}

}  // namespace crossnav::world
