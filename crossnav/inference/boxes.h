// SPDX-License-Identifier: MIT
// Boxes of detectors, before they become detections of a goal.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/inference/model_card.h"
#include "crossnav/perception/perception.h"

namespace crossnav::inference {

struct FoundBox {
  double left = 0, top = 0, right = 0, bottom = 0;  ///< [px of the frame, or of the input]
  double score = 0;
  int label = 0;
  std::size_t index = 0;  ///< position in the network's output
};

/// Intersection over union.
double Overlap(const FoundBox& a, const FoundBox& b);

/// Non-maximum suppression: the best box of each class among boxes that overlap by more than
/// `overlap`; best first.
std::vector<FoundBox> Suppress(std::vector<FoundBox> boxes, double overlap);

/// Labels that mean the goal: labels of its category in the table of names (core/category_table.h),
/// or the exact name. Never a substring.
std::vector<int> LabelsOf(std::string_view goal, const std::vector<std::string>& labels);

/// Error that lists the classes, for a goal without a label.
tl::unexpected<Error> NoSuchLabel(std::string_view goal, const ModelCard& card);

}  // namespace crossnav::inference
