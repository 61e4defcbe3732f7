// SPDX-License-Identifier: MIT
// The dense-encoder part of ground-truth perception.
#pragma once

#include <memory>

#include "crossnav/perception/perception.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::sim {

/// Ground truth's encoder, which encodes images of instances.
class InstanceEncoder : public perception::DenseEncoder {
 public:
  /// Features of a view; its noise follows from the pose.
  virtual perception::FeatureGrid EncodeInstances(const InstanceImage& image,
                                                  const Pose& T_world_camera) = 0;
};

/// Features answered from the instance image of `simulator`'s last frame. With `clip_dir` set, in
/// the space of real CLIP text vectors: that folder holds `oid_names.txt` (a name a line) and
/// `oid_clip_a+cname.npy` (a float16 or float32 row for each). Then words are as near as CLIP finds
/// them: "couch" and "loveseat" find a sofa. The file gives the dimension; names it does not know
/// get a vector of their own with CLIP's common share. Errors: those of the two files.
Result<std::unique_ptr<InstanceEncoder>> MakeGroundTruthEncoder(const Simulator& simulator,
                                                                const GroundTruthConfig& config);

/// The same for texts alone; pictures are kUnsupported.
Result<std::unique_ptr<perception::DenseEncoder>> MakeGroundTruthTexts(
    const GroundTruthConfig& config);

/// The errors that MakeGroundTruthEncoder would report, before anything else is done.
Result<void> CheckGroundTruthEncoder(const GroundTruthConfig& config);

}  // namespace crossnav::sim
