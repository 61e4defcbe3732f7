// SPDX-License-Identifier: MIT
// What a raw semantic name says about an object: whether it is ground, carries small things, stands
// as a landmark of its room, or is moved by people. By whole words; names of HM3D, of generated
// houses and of imported homes.
#pragma once

#include <string_view>

namespace crossnav::world {

/// Floors, balconies and what lies flat on them.
bool IsGround(std::string_view name);
/// Pieces with a top that small things are put on.
bool HasTop(std::string_view name);
/// Large pieces that others are said to stand beside.
bool IsLandmark(std::string_view name);
/// Chairs, plants, lamps and the like. Fixtures, beds and what is built in stay where they are.
bool IsMovable(std::string_view name, std::string_view category);
/// A leaf or a whole door, not its frame.
bool IsDoor(std::string_view name);
bool IsWall(std::string_view name);
bool IsStairs(std::string_view name);
/// Fixtures that tell a bathroom, or a kitchen.
bool IsBathFixture(std::string_view name);
bool IsKitchenFixture(std::string_view name);

}  // namespace crossnav::world
