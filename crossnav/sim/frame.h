// SPDX-License-Identifier: MIT
// What a simulated camera sees.
#pragma once

#include "crossnav/core/image.h"

namespace crossnav::sim {

/// What a picture is to hold. Shading and texture look-ups are half of its cost.
enum class Channels { kAll, kWithoutColour };

struct Frame {
  RgbImage rgb;            ///< black where colour was not asked for
  DepthImage depth_m;      ///< planar z, 0 where no surface
  InstanceImage instance;  ///< 0 where none
};

}  // namespace crossnav::sim
