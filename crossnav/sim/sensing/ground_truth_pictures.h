// SPDX-License-Identifier: MIT
// Goals as pictures under ground-truth perception: the category and the mask of the object are
// those of the scene at the place where the picture was taken, the features those of ground truth's
// encoder there. The agent's policy gets the reading alone: no place, no instance.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::sim {

/// Reads the pictures in `known`. Error kUnsupported: another picture; kMismatch: a picture whose
/// object is not in the simulator's scene, or not in the view.
Result<std::unique_ptr<perception::PictureReader>> MakeGroundTruthPictureReader(
    const Simulator& simulator, const GroundTruthConfig& config, KnownPictures known);

}  // namespace crossnav::sim
