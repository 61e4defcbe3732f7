// SPDX-License-Identifier: MIT
#include "crossnav/serve/command.h"

#include "crossnav/core/pose.h"

namespace crossnav::serve {

Command CommandOf(Action action, const ActionConfig& sizes, double period_s) {
  const double v_mps = sizes.forward_m / period_s;
  const double w_radps = DegToRad(sizes.turn_deg) / period_s;
  const double pitch_radps = DegToRad(sizes.pitch_deg) / period_s;
  switch (action) {
    case Action::kMoveForward:
      return {v_mps, 0, 0, period_s};
    case Action::kTurnLeft:
      return {0, w_radps, 0, period_s};
    case Action::kTurnRight:
      return {0, -w_radps, 0, period_s};
    case Action::kLookUp:
      return {0, 0, pitch_radps, period_s};
    case Action::kLookDown:
      return {0, 0, -pitch_radps, period_s};
    case Action::kStop:
      break;
  }
  return {};
}

}  // namespace crossnav::serve
