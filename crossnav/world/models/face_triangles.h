// SPDX-License-Identifier: MIT
// Triangulates a flat face with any number of corners, including concave faces and faces with
// bridges to their holes (as in door frames).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::world {

/// Indices into `corners`. A fan from the first corner if the face is convex, or has more than 1000
/// corners.
std::vector<std::array<std::size_t, 3>> FaceTriangles(std::span<const Vector3f> corners);

}  // namespace crossnav::world
