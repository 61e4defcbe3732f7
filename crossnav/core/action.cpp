// SPDX-License-Identifier: MIT
#include "crossnav/core/action.h"

namespace crossnav {

std::string_view NameOf(Action action) {
  switch (action) {
    case Action::kMoveForward:
      return "move_forward";
    case Action::kTurnLeft:
      return "turn_left";
    case Action::kTurnRight:
      return "turn_right";
    case Action::kLookUp:
      return "look_up";
    case Action::kLookDown:
      return "look_down";
    case Action::kStop:
      return "stop";
  }
  return "unknown";
}

}  // namespace crossnav
