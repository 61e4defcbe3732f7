// SPDX-License-Identifier: MIT
// A discrete action as speeds of a robot that can turn on the spot.
#pragma once

#include "crossnav/core/action.h"

namespace crossnav::serve {

/// Hold for `duration_s`, then stand still. All zero: stand still now.
struct Command {
  double v_mps = 0;        ///< ahead
  double w_radps = 0;      ///< counter-clockwise seen from above
  double pitch_radps = 0;  ///< of the camera, up
  double duration_s = 0;
  friend bool operator==(const Command&, const Command&) = default;
};

/// The action spread over `period_s`; standing still for kStop.
Command CommandOf(Action action, const ActionConfig& sizes, double period_s);

}  // namespace crossnav::serve
