// SPDX-License-Identifier: MIT
// Light sources of a house.
#include <algorithm>
#include <cmath>

#include "crossnav/world/plan/plan_walls.h"
#include "crossnav/world/surface/bake_light.h"

namespace crossnav::world {
namespace {

constexpr double kSky =
    4.0;  // chosen by eye, as all powers here: a window 2 m away suffices to read
constexpr double kCeilingLamp_m2 = 1.7, kStandingLamp_m2 = 0.8;
const Vector3d kDaylight(0.95, 0.99, 1.05), kLamplight(1.07, 1.0, 0.88);
constexpr double kBase = 0.26;    // chosen: minimum light of a room
constexpr double kBounce = 0.28;  // chosen: reflected share of light
constexpr double kLeastBounce = 0.1, kMostBounce = 0.42;

Light WindowOf(const HousePlan& plan, const Wall& wall, const Opening& o) {
  const Vector2d d = (wall.b - wall.a).normalized();
  Vector2d n(-d.y(), d.x());
  const Vector2d c = wall.a + d * o.center_m;
  if (RoomAt(plan, wall.level, c + 0.3 * n) < 0) n = -n;
  const double z = plan.levels[static_cast<std::size_t>(wall.level)].floor_m;
  Light light;
  light.inward = {n.x(), n.y(), 0};
  light.p_world = Vector3d(c.x(), c.y(), z + 0.5 * (o.sill_m + o.head_m)) +
                  (0.5 * wall.thickness_m + 0.02) * light.inward;
  light.half_width = 0.5 * o.width_m * Vector3d(d.x(), d.y(), 0);
  light.half_height = {0, 0, 0.5 * (o.head_m - o.sill_m)};
  light.colour = kDaylight;
  light.power = kSky;
  light.room = RoomAt(plan, wall.level, c + 0.3 * n);
  return light;
}

/// nullopt if the object is no lamp.
std::optional<Light> LampOf(const Placement& thing) {
  const std::string& name = thing.model.name;
  const bool is_ceiling = name == "ceiling lamp";
  if (!is_ceiling && name != "floor lamp" && name != "table lamp") return std::nullopt;
  const Box3 box = BoxAt(thing.model, thing.T_world_object);
  Light light;
  light.p_world = box.Center();
  light.p_world.z() = is_ceiling ? box.min.z() - 0.06 : box.max.z() + 0.08;
  light.colour = kLamplight;
  light.power = is_ceiling ? kCeilingLamp_m2 : kStandingLamp_m2;
  light.room = thing.room;
  return light;
}

double AreaOf(const Room& room) {
  double area_m2 = 0;
  for (const Rect& r : room.rects) area_m2 += r.Area();
  return std::max(area_m2, 1.0);
}

}  // namespace

HouseLights LightsOf(const HousePlan& plan) {
  HouseLights all;
  for (const Wall& wall : plan.walls) {
    for (const Opening& o : wall.openings) {
      if (o.kind == OpeningKind::kWindow) all.lights.push_back(WindowOf(plan, wall, o));
    }
  }
  for (const Placement& thing : plan.furniture) {
    if (auto lamp = LampOf(thing)) all.lights.push_back(*lamp);
  }
  std::vector<Vector3d> flux(plan.rooms.size(), Vector3d::Zero());
  for (const Light& light : all.lights) {
    if (light.room < 0) continue;
    const double area_m2 = 4 * light.half_width.norm() * light.half_height.norm();
    const double share = light.power * (light.IsWindow() ? area_m2 : 4.0);
    flux[static_cast<std::size_t>(light.room)] += share * light.colour;
  }
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const Vector3d back = kBounce * flux[i] / AreaOf(plan.rooms[i]);
    all.bounced.push_back(Vector3d::Constant(kBase) +
                          back.cwiseMax(kLeastBounce).cwiseMin(kMostBounce));
  }
  return all;
}

}  // namespace crossnav::world
