// SPDX-License-Identifier: MIT
// Triangles of one flat face with any number of corners, concave ones and ones with bridges to
// their holes included (door frames are drawn so).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::world {

/// Indices into `corners`. A fan from the first corner where the face is convex, or has more than
/// 1000 corners.
std::vector<std::array<std::size_t, 3>> FaceTriangles(std::span<const Vector3f> corners);

}  // namespace crossnav::world
