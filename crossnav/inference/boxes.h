// SPDX-License-Identifier: MIT
// Boxes as detectors give them, before they are detections of a goal.
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
  std::size_t index = 0;  ///< where the network had it
};

/// Intersection over union.
double Overlap(const FoundBox& a, const FoundBox& b);

/// The best box of each class where several overlap by more than `overlap`; best first.
std::vector<FoundBox> Suppress(std::vector<FoundBox> boxes, double overlap);

/// Which of the labels mean the goal: those of its category in the one table of names
/// (core/category_table.h), or that very name. Never a substring.
std::vector<int> LabelsOf(std::string_view goal, const std::vector<std::string>& labels);

/// An error that says which classes there are, for a goal that none of the labels means.
tl::unexpected<Error> NoSuchLabel(std::string_view goal, const ModelCard& card);

}  // namespace crossnav::inference
