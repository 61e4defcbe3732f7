// SPDX-License-Identifier: MIT
// Perception that sees nothing: an agent with it maps and explores, and never finds a goal. It
// stands in where there are no networks, as `serve --perception none`, and in tests.
#pragma once

#include "crossnav/perception/perception.h"

namespace crossnav::serve {

/// No boxes, no stairs, and features that are like no text.
perception::PerceptionSuite BlindPerception();

}  // namespace crossnav::serve
