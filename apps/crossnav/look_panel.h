// SPDX-License-Identifier: MIT
// What networks see in a frame, as a picture for people.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"

namespace crossnav::app {

/// Everything that was asked of one frame. What nobody answers is empty.
struct Look {
  struct Found {
    std::string goal;
    perception::Detection detection;
  };
  std::vector<Found> found;
  Image<float> stairs;      ///< probability, H x W
  Image<float> similarity;  ///< to the text, one number a cell
  std::string text;
};

/// Four fields of the frame's size, at most 640 px wide each: boxes and masks, stairs, depth,
/// similarity.
RgbImage LookPanel(const Observation& obs, const Look& look);

}  // namespace crossnav::app
