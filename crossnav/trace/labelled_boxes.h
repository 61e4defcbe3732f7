// SPDX-License-Identifier: MIT
// Boxes with labels and lines between places as one message foxglove.SceneUpdate, for graphs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/image.h"

namespace crossnav::trace {

struct LabelledBox {
  Box3 box;
  std::string label;  ///< empty = none
  Rgb8 colour;
  double alpha = 0.3;
};

struct PlaceLine {
  Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();
  Rgb8 colour;
};

/// Replaces the entity of this name.
std::string EncodeBoxes(std::uint64_t time_ns, std::string_view entity,
                        const std::vector<LabelledBox>& boxes, const std::vector<PlaceLine>& lines);

}  // namespace crossnav::trace
