// SPDX-License-Identifier: MIT
// Results of networks for a frame, as a picture.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"

namespace crossnav::app {

/// Results of all networks for one frame; empty parts were not computed.
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
