// SPDX-License-Identifier: MIT
// Changes of a house for people to read.
#pragma once

#include <string>

#include "crossnav/world/change/changes.h"

namespace crossnav::app {

/// A line: kind, object, from where to where.
std::string ChangeText(const world::Change& change);

}  // namespace crossnav::app
