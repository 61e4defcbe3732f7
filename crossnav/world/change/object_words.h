// SPDX-License-Identifier: MIT
// Properties of an object by its raw semantic name: ground, carrier of small objects, landmark of
// its room, or moved by people. Matches whole words of names in HM3D, generated houses and imported
// homes.
#pragma once

#include <string_view>

namespace crossnav::world {

/// Floors, balconies and flat objects on them.
bool IsGround(std::string_view name);
/// Furniture whose top carries small objects.
bool HasTop(std::string_view name);
/// Large furniture, as a reference for objects beside it.
bool IsLandmark(std::string_view name);
/// Chairs, plants, lamps and similar objects. Fixtures, beds and built-in furniture never move.
bool IsMovable(std::string_view name, std::string_view category);
/// A leaf or a whole door, not its frame.
bool IsDoor(std::string_view name);
bool IsWall(std::string_view name);
bool IsStairs(std::string_view name);
/// Fixtures that identify a bathroom or a kitchen.
bool IsBathFixture(std::string_view name);
bool IsKitchenFixture(std::string_view name);

}  // namespace crossnav::world
