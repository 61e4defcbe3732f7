// SPDX-License-Identifier: MIT
// Several detectors as one: the first that has a label for the goal answers. The paper's: YOLOv7
// for the classes of COCO, YOLO-World for every other goal.
#pragma once

#include <memory>
#include <vector>

#include "crossnav/perception/perception.h"

namespace crossnav::inference {

/// A detector has no label for a goal where it answers kUnsupported; any other error ends the
/// search. The error of the last detector stands where none has. One detector stays itself, none is
/// nullptr.
std::unique_ptr<perception::Detector> MakeDetectorByGoal(
    std::vector<std::unique_ptr<perception::Detector>> detectors);

}  // namespace crossnav::inference
