// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "crossnav/core/check.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/trials/trial_worlds.h"
#include "crossnav/world/furniture/furniture.h"
#include "crossnav/world/plan/plan_walls.h"

namespace crossnav::evaluation {

using world::HousePlan;
using world::Opening;
using world::OpeningKind;
using world::Room;
using world::RoomType;
using world::StairBlock;
using world::StairKind;
using world::StairParams;

namespace {

constexpr double kHall_m = 3.6;  // chosen: room for a look around and for the goal
constexpr double kBeside_m =
    1.5;  // chosen: the hall is this much longer than the stair at each end

int AddRoom(HousePlan& plan, RoomType type, int level, std::vector<world::Rect> rects) {
  Room room;
  room.type = type;
  room.name = type == RoomType::kStairwell ? "stairwell" : "hall";
  room.level = level;
  room.rects = std::move(rects);
  plan.rooms.push_back(std::move(room));
  return static_cast<int>(plan.rooms.size()) - 1;
}

/// Dimensions as in the generator: a comfortable flight for the rise, by Blondel's rule.
StairParams DrawParams(StairKind kind, Rng& rng) {
  StairParams params;
  params.kind = kind;
  params.slab_m = 0.01 * rng.Int(20, 30);
  params.rise_m = 2.3 + 0.05 * rng.Int(0, 12) + params.slab_m;
  params.risers =
      std::clamp(static_cast<int>(std::lround(params.rise_m / rng.Uniform(0.165, 0.195))),
                 static_cast<int>(std::ceil(params.rise_m / 0.21)),
                 static_cast<int>(std::floor(params.rise_m / 0.15)));
  params.tread_m = std::clamp(0.63 - 2 * params.rise_m / params.risers, 0.24, 0.32);
  params.width_m = rng.Uniform(0.8, kind == StairKind::kSpiral ? 1.0 : 1.2);
  params.body = static_cast<world::StairBody>(rng.Int(0, 2));
  params.rail_style = rng.Chance(0.5) ? 0 : rng.Int(1, 2);
  params.has_right_rail = kind != StairKind::kBasement;
  return params;
}

StairParams DrawParams(const StairVariant& variant, Rng& rng) {
  StairParams params = DrawParams(variant.kind, rng);
  const world::Storeys storeys{params.rise_m, params.rise_m, params.slab_m};
  const auto risers = world::RisersFor(storeys, variant.range.riser_m.Draw(rng), {0.1, 0.295});
  CROSSNAV_CHECK(risers.has_value(), "no number of risers for a stair");
  params.risers = *risers;
  params.tread_m = variant.range.tread_m.Draw(rng);
  params.width_m = variant.range.width_m.Draw(rng);
  params.landing_m = variant.landing_m;
  return params;
}

void AddGoal(HousePlan& plan, world::ObjectModel model, const Vector3d& p_world, int room) {
  plan.furniture.push_back({std::move(model), world::StandAt(p_world, 0), room});
}

/// An opening of the stairwell's wall towards the hall of its level.
void OpenStairwell(HousePlan& plan, int stairwell, int hall, double x0, double x1, bool has_door) {
  world::Wall* wall = world::FindWall(plan, stairwell, hall);
  CROSSNAV_CHECK(wall != nullptr, "a stairwell without a wall");
  Opening opening;
  opening.kind = has_door ? OpeningKind::kDoorOpen : OpeningKind::kPassage;
  opening.width_m = 0.8;
  opening.center_m = std::abs(0.5 * (x0 + x1) - wall->a.x());
  opening.opens_left = wall->room == hall;  // away from the steps
  CROSSNAV_CHECK(world::AddOpening(*wall, opening), "a stairwell's opening finds no place");
}

StairWorld MakeStoreys(const StairParams& params, Rng& rng) {
  const StairKind kind = params.kind;
  const StairBlock block = world::MakeStairBlock(params);
  const world::Rect hall{-kBeside_m, -kHall_m, block.width_m + kBeside_m, 0};
  const world::Rect shaft{0, 0, block.width_m, block.depth_m};
  const bool is_enclosed = kind == StairKind::kBasement;
  StairWorld made;
  HousePlan& plan = made.plan;
  made.upper_m = params.rise_m;
  int halls[2], stairwells[2];
  for (int level = 0; level < 2; ++level) {
    plan.levels.push_back({level * params.rise_m, (level + 1) * params.rise_m - params.slab_m});
    halls[level] = AddRoom(plan, RoomType::kHall, level,
                           is_enclosed ? std::vector{hall} : std::vector{hall, shaft});
    stairwells[level] =
        is_enclosed ? AddRoom(plan, RoomType::kStairwell, level, {shaft}) : halls[level];
  }
  world::Stair stair = block.stair;
  stair.room = stairwells[0];
  made.p_foot_world = stair.p_bottom;
  made.p_top_world = stair.p_top;
  plan.stairs.push_back(std::move(stair));
  world::DeriveWalls(plan, {});
  if (is_enclosed) {
    OpenStairwell(plan, stairwells[0], halls[0], block.entry_x0, block.entry_x1, false);
    OpenStairwell(plan, stairwells[1], halls[1], block.exit_x0, block.exit_x1, true);
  }
  world::RailVoids(plan, params.rail_style);
  const auto place = [&](double z_m) {
    return Vector3d(rng.Uniform(hall.x0 + 1.2, hall.x1 - 1.2), hall.y0 + 0.6, z_m);
  };
  AddGoal(plan, world::MakeSofa(rng), place(0), halls[0]);
  AddGoal(plan, world::MakeChair(rng), place(params.rise_m), halls[1]);
  return made;
}

/// A corridor, and across its end a room three to seven risers lower.
StairWorld MakeSplitLevel(Rng& rng) {
  StairWorld made;
  HousePlan& plan = made.plan;
  plan.levels.push_back({0, 2.6});
  const int hall = AddRoom(plan, RoomType::kHall, 0, {{-5, 0, 0, kHall_m}});
  const int sunken = AddRoom(plan, RoomType::kLiving, 0, {{0, 0, 6, kHall_m}});
  const int risers = rng.Int(3, 7);
  const double riser_m = rng.Uniform(0.15, 0.18), tread_m = rng.Uniform(0.27, 0.32);
  const double run_m = (risers - 1) * tread_m, middle_m = 0.5 * kHall_m;
  made.lower_m = plan.rooms[static_cast<std::size_t>(sunken)].offset_m = -risers * riser_m;
  world::Stair steps = world::Moved(world::MakeSteps(-made.lower_m, risers, tread_m, 1.3),
                                    {run_m, middle_m, made.lower_m}, 2);
  steps.lower_level = steps.upper_level = 0;
  steps.room = sunken;
  made.p_foot_world = steps.p_bottom;
  made.p_top_world = steps.p_top;
  plan.stairs.push_back(std::move(steps));
  world::DeriveWalls(plan, {});
  world::Wall* wall = world::FindWall(plan, hall, sunken);
  CROSSNAV_CHECK(wall != nullptr, "a sunken room without a wall");
  Opening passage;
  passage.kind = OpeningKind::kPassage;
  passage.width_m = 1.1;
  passage.center_m = middle_m - wall->a.y();
  CROSSNAV_CHECK(world::AddOpening(*wall, passage), "a passage finds no place");
  const double sofa_x = rng.Uniform(3.5, 4.8);
  AddGoal(plan, world::MakeSofa(rng), {sofa_x, 0.6, made.lower_m}, sunken);
  const double chair_x = rng.Uniform(-4.2, -2.0);
  AddGoal(plan, world::MakeChair(rng), {chair_x, 0.6, 0}, hall);
  return made;
}

std::string IdOf(std::string_view kind, std::uint64_t seed) {
  std::string name(kind);
  std::replace(name.begin(), name.end(), ' ', '_');
  const std::string number = std::to_string(seed % 100000);
  return std::string(5 - number.size(), '0') + number + "-" + name;
}

}  // namespace

StairWorld MakeStairWorld(StairKind kind, std::uint64_t seed) {
  Rng rng(seed, static_cast<std::uint64_t>(kind));
  const bool is_split = kind == StairKind::kSplitLevel;
  StairWorld made = is_split ? MakeSplitLevel(rng) : MakeStoreys(DrawParams(kind, rng), rng);
  made.plan.id = IdOf(world::NameOf(kind), seed);
  return made;
}

StairWorld MakeStairWorld(const StairVariant& variant, std::uint64_t seed) {
  Rng rng(seed, HashString(variant.name));
  StairWorld made = MakeStoreys(DrawParams(variant, rng), rng);
  made.plan.id = IdOf(variant.name, seed);
  return made;
}

}  // namespace crossnav::evaluation
