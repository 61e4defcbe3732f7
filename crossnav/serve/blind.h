// SPDX-License-Identifier: MIT
// Blind perception: an agent with it maps and explores, and never finds a goal. Substitute without
// networks, as in `serve --perception none` and in tests.
#pragma once

#include "crossnav/perception/perception.h"

namespace crossnav::serve {

/// No boxes, no stairs, and features orthogonal to every text.
perception::PerceptionSuite BlindPerception();

}  // namespace crossnav::serve
