// SPDX-License-Identifier: MIT
#include "crossnav/world/shell/architecture.h"

#include <cmath>

namespace crossnav::world {
namespace {

constexpr double kTopSlab_m = 0.2;  // chosen: thickness of the roof slab

/// Half the gap between a ceiling and the floor above, so that slabs close the edges of stairwells.
double SlabHalf(const HousePlan& plan, std::size_t level) {
  if (level + 1 >= plan.levels.size()) return kTopSlab_m;
  return 0.5 * (plan.levels[level + 1].floor_m - plan.levels[level].ceiling_m);
}

void AddSlabs(const Rect& rect, const std::vector<Rect>& holes, double z0, double z1,
              MeshBuilder& mesh) {
  for (const Rect& r : Subtract(rect, holes)) {
    mesh.AddBox({r.x0, r.y0, z0}, {r.x1, r.y1, z1});
  }
}

void BuildCeiling(const HousePlan& plan, std::size_t index, SceneBuilder& scene) {
  const Room& room = plan.rooms[index];
  if (!room.has_ceiling) return;
  const auto level = static_cast<std::size_t>(room.level);
  const double ceiling = plan.levels[level].ceiling_m;
  scene.BeginInstance("ceiling", static_cast<int>(index));
  scene.Use(room.ceiling);
  const auto holes_above = plan.VoidsOf(room.level + 1);
  const double above = SlabHalf(plan, level);
  for (const Rect& r : room.rects) AddSlabs(r, holes_above, ceiling, ceiling + above, scene.mesh);
}

}  // namespace

void BuildFloorsAndCeilings(const HousePlan& plan, SceneBuilder& scene) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const Room& room = plan.rooms[i];
    const auto level = static_cast<std::size_t>(room.level);
    const double floor = plan.levels[level].floor_m + room.offset_m;
    const double below = level == 0 ? kTopSlab_m : SlabHalf(plan, level - 1);

    if (room.type == RoomType::kVoid) {
      BuildCeiling(plan, i, scene);
      continue;
    }
    scene.BeginInstance(room.type == RoomType::kBalcony ? "balcony" : "floor", static_cast<int>(i));
    scene.Use(room.floor);
    const auto holes = plan.VoidsOf(room.level);
    for (const Rect& r : room.rects) AddSlabs(r, holes, floor - below, floor, scene.mesh);
    BuildCeiling(plan, i, scene);
  }
}

void BuildRailing(const Railing& railing, SceneBuilder& scene) {
  const Vector3d up(0, 0, railing.height_m);
  const Vector3d along = railing.b - railing.a;
  const double run = along.head<2>().norm();
  if (run < 0.05) return;
  MeshBuilder& mesh = scene.mesh;
  constexpr Rgb8 kWood{120, 84, 56}, kSteel{150, 152, 155}, kPaint{232, 230, 224};
  if (railing.style == 1) {
    mesh.material = scene.Material(kPaint);
    const Vector2d n = Vector2d(-along.y(), along.x()).normalized() * 0.04;
    const Vector3d side(n.x(), n.y(), 0);
    const Vector3d low(0, 0, -0.15);
    const Vector3d a0 = railing.a - side, a1 = railing.a + side;
    const Vector3d b0 = railing.b - side, b1 = railing.b + side;
    mesh.AddQuad(a0 + low, b0 + low, b0 + up, a0 + up);
    mesh.AddQuad(b1 + low, a1 + low, a1 + up, b1 + up);
    mesh.AddQuad(a0 + up, b0 + up, b1 + up, a1 + up);
    mesh.AddQuad(a1 + low, a0 + low, a0 + up, a1 + up);
    mesh.AddQuad(b0 + low, b1 + low, b1 + up, b0 + up);
    return;
  }
  mesh.material = scene.Material(kWood);
  mesh.AddBar(railing.a + up, railing.b + up, 0.03, 8);
  mesh.material = scene.Material(railing.style == 0 ? kPaint : kSteel);
  if (railing.style == 2) {
    for (double h : {0.2, 0.4, 0.6, 0.78}) {
      const Vector3d z(0, 0, h * railing.height_m / 0.95);
      mesh.AddBar(railing.a + z, railing.b + z, 0.009, 6);
    }
  }
  const double spacing = railing.style == 0 ? 0.13 : 0.9;  // chosen: usual baluster spacing
  const int count = std::max(1, static_cast<int>(std::ceil(run / spacing)));
  for (int i = 0; i <= count; ++i) {
    const Vector3d foot = railing.a + along * (static_cast<double>(i) / count);
    const double r = (i == 0 || i == count || railing.style != 0) ? 0.025 : 0.012;
    mesh.AddBox(foot + Vector3d(-r, -r, -0.1), foot + up + Vector3d(r, r, 0.01));
  }
}

void BuildStairs(const HousePlan& plan, SceneBuilder& scene) {
  for (const Stair& stair : plan.stairs) {
    scene.BeginInstance("stairs", std::max(0, stair.room));
    scene.Use(stair.finish);
    const double ground = stair.ground_m;
    for (const Tread& tread : stair.treads) {
      double bottom = tread.top_m - stair.thickness_m;
      if (stair.body == StairBody::kSolid) bottom = ground;
      if (stair.body == StairBody::kClosed) bottom = tread.top_m - stair.riser_m - 0.06;
      scene.mesh.AddPrism(tread.polygon, std::max(bottom, ground), tread.top_m);
    }
    if (stair.column) scene.mesh.AddPrism(stair.column->polygon, ground, stair.column->top_m);
    if (stair.railings.empty()) continue;
    scene.BeginInstance("railing", std::max(0, stair.room));
    for (const Railing& railing : stair.railings) BuildRailing(railing, scene);
  }
  if (plan.railings.empty()) return;
  scene.BeginInstance("railing", 0);
  for (const Railing& railing : plan.railings) BuildRailing(railing, scene);
}

BuiltHouse BuildHouseWithLights(const HousePlan& plan, const BuildOptions& options) {
  SceneBuilder scene;
  scene.has_textures = options.has_textures;
  scene.texture_seed = options.texture_seed;
  BuildFloorsAndCeilings(plan, scene);
  BuildWalls(plan, scene);
  BuildStairs(plan, scene);
  BuildBlocks(plan, scene);
  scene.mesh.RemoveOverlaps();  // walls share their corners
  for (const Placement& p : plan.furniture) scene.Place(p.model, p.T_world_object, p.room);
  return {scene.Finish(plan.id), std::move(scene.glowing)};
}

sim::Scene BuildHouse(const HousePlan& plan, const BuildOptions& options) {
  return BuildHouseWithLights(plan, options).scene;
}

}  // namespace crossnav::world
