// SPDX-License-Identifier: MIT
// Several detectors as one: the first detector with a label for the goal answers. The paper's:
// YOLOv7 for the classes of COCO, YOLO-World for every other goal.
#pragma once

#include <memory>
#include <vector>

#include "crossnav/perception/perception.h"

namespace crossnav::inference {

/// kUnsupported from a detector passes the goal to the next; any other error ends the search. If no
/// detector has a label, the last error is returned. A single detector is returned itself; none
/// gives nullptr.
std::unique_ptr<perception::Detector> MakeDetectorByGoal(
    std::vector<std::unique_ptr<perception::Detector>> detectors);

}  // namespace crossnav::inference
