// SPDX-License-Identifier: MIT
// Checks of an observation and of its percept, before either reaches the
// map.
#pragma once

#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/perception/perception.h"

namespace crossnav::agent {

/// Errors name the key: poses that are not finite and rigid, images of another size than their
/// intrinsics, a mounting that no robot has.
Result<void> CheckObservation(const Observation& obs);

/// Checks that masks fit the frame and that confidences are finite.
Result<void> CheckDetections(const std::vector<perception::Detection>& detections,
                             const Observation& obs);

/// Checks that a network's answer fits the frame: an error that names it, never a read out of
/// bounds.
Result<void> CheckPercept(const perception::Percept& percept, const Observation& obs);

}  // namespace crossnav::agent
