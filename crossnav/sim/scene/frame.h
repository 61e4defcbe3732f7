// SPDX-License-Identifier: MIT
// Frame of a simulated camera.
#pragma once

#include "crossnav/core/image.h"

namespace crossnav::sim {

/// Contents of a requested picture. Shading and texture look-ups are half of its cost.
enum class Channels { kAll, kWithoutColour };

struct Frame {
  RgbImage rgb;            ///< black if colour was not requested
  DepthImage depth_m;      ///< planar z, 0 where no surface
  InstanceImage instance;  ///< 0 where none
};

}  // namespace crossnav::sim
