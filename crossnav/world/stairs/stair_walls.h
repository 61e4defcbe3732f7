// SPDX-License-Identifier: MIT
// Measures of stairs between walls.
#pragma once

namespace crossnav::world {

inline constexpr double kWall_m = 0.06;      // half a wall
inline constexpr double kIntoWall_m = 0.03;  // treads end inside the wall, so that no gap shows
inline constexpr double kGap_m = 0.12;       // chosen: between the two flights of a U

}  // namespace crossnav::world
