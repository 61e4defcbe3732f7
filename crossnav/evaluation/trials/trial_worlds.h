// SPDX-License-Identifier: MIT
// Small worlds around a stair of each kind, or around an object that may be mistaken for a stair.
// Built from parts of the house generator; seeded. World frame, metres.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "crossnav/world/layout/stair_draw.h"
#include "crossnav/world/plan/plan.h"
#include "crossnav/world/stairs/stairs.h"

namespace crossnav::evaluation {

/// Every kind of stair that the generator builds.
inline constexpr std::array<world::StairKind, 9> kStairKinds = {
    world::StairKind::kStraight,   world::StairKind::kStraightLanding, world::StairKind::kL,
    world::StairKind::kU,          world::StairKind::kWinder,          world::StairKind::kSpiral,
    world::StairKind::kSplitLevel, world::StairKind::kDouble,          world::StairKind::kBasement};

/// A kind of stair with its own dimensions.
struct StairVariant {
  std::string_view name;
  world::StairKind kind;
  world::StairRange range;
  double landing_m = 0;  ///< 0 = as long as the flight is wide
};

/// Stairs that the second edition of the generator builds and the first does not.
inline constexpr std::array<StairVariant, 7> kStairVariants = {{
    {"narrow treads", world::StairKind::kStraight, {{0.17, 0.22}, {0.15, 0.22}, {0.7, 1.1}}},
    {"high risers", world::StairKind::kStraight, {{0.25, 0.295}, {0.20, 0.30}, {0.7, 1.1}}},
    {"steep winders", world::StairKind::kWinder, {{0.20, 0.25}, {0.18, 0.22}, {0.65, 0.9}}},
    {"half turn of winders",
     world::StairKind::kHalfWinder,
     {{0.17, 0.22}, {0.20, 0.28}, {0.7, 1.0}}},
    {"deep half landing", world::StairKind::kU, {{0.16, 0.20}, {0.24, 0.30}, {0.8, 1.2}}, 1.8},
    {"steep cellar", world::StairKind::kBasement, {{0.22, 0.28}, {0.15, 0.20}, {0.7, 0.9}}},
    {"attic", world::StairKind::kAttic, {{0.22, 0.28}, {0.15, 0.20}, {0.65, 0.9}}},
}};

inline constexpr const char* kGoalAbove = "chair";  ///< stands on the upper floor only
inline constexpr const char* kGoalBelow = "sofa";   ///< stands on the lower floor only

/// Two floors and a stair between them: a hall before the stair on each, with a goal in it.
struct StairWorld {
  world::HousePlan plan;
  double lower_m = 0, upper_m = 0;           ///< heights of the floors
  Vector3d p_foot_world = Vector3d::Zero();  ///< standing place before the first riser
  Vector3d p_top_world = Vector3d::Zero();   ///< standing place after the last riser
};

/// Dimensions, body and railings are drawn from the seed as in the generator; a split level has 3
/// to 7 risers, a basement's stair its own walls and a door.
StairWorld MakeStairWorld(world::StairKind kind, std::uint64_t seed);
StairWorld MakeStairWorld(const StairVariant& variant, std::uint64_t seed);

/// Objects that look like stairs and lead to no other floor.
enum class FalseEntrance { kGallery, kBalcony, kWindow, kFurniture, kShelf, kSlope, kSeat, kStack };
inline constexpr std::array<FalseEntrance, 8> kFalseEntrances = {
    FalseEntrance::kGallery,   FalseEntrance::kBalcony, FalseEntrance::kWindow,
    FalseEntrance::kFurniture, FalseEntrance::kShelf,   FalseEntrance::kSlope,
    FalseEntrance::kSeat,      FalseEntrance::kStack};

/// "gallery", "balcony", "window", "furniture", "shelf like steps", "slope to nowhere",
/// "seat beside a wall", "stack of low furniture"
std::string_view NameOf(FalseEntrance kind);

/// Rooms on the floor of the start without an exit.
struct FalseWorld {
  world::HousePlan plan;
  double start_m = 0;                        ///< height of the floor of the start
  Vector3d p_seen_world = Vector3d::Zero();  ///< of the false entrance
};

FalseWorld MakeFalseWorld(FalseEntrance kind, std::uint64_t seed);

}  // namespace crossnav::evaluation
