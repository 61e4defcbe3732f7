// SPDX-License-Identifier: MIT
// The dense-encoder part of ground-truth perception.
#pragma once

#include <memory>

#include "crossnav/perception/perception.h"
#include "crossnav/sim/ground_truth.h"

namespace crossnav::sim {

/// Features answered from the instance image of `simulator`'s last frame.
std::unique_ptr<perception::DenseEncoder> MakeGroundTruthEncoder(const Simulator& simulator,
                                                                 const GroundTruthConfig& config);

}  // namespace crossnav::sim
