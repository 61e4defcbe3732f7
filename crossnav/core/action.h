// SPDX-License-Identifier: MIT
// The six discrete actions and their sizes (paper, "Task Formulation").
#pragma once

#include <string_view>

#include "crossnav/core/setting.h"

namespace crossnav {

enum class Action { kMoveForward, kTurnLeft, kTurnRight, kLookUp, kLookDown, kStop };

/// "move_forward", "turn_left", ...
std::string_view NameOf(Action action);

struct ActionConfig {
  double forward_m = 0.25;
  double turn_deg = 30;
  double pitch_deg = 30;
  double max_pitch_deg = 60;  // chosen: two pitch steps, as in Habitat's ObjectNav stacks
};

template <class V>
void Visit(V& visit, ActionConfig& c) {
  visit(CROSSNAV_SETTING(c, forward_m), 0.01, 2.0);
  visit(CROSSNAV_SETTING(c, turn_deg), 1.0, 180.0);
  visit(CROSSNAV_SETTING(c, pitch_deg), 1.0, 90.0);
  visit(CROSSNAV_SETTING(c, max_pitch_deg), 0.0, 90.0);
}

}  // namespace crossnav
