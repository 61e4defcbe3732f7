// SPDX-License-Identifier: MIT
#pragma once

#include "crossnav/evaluation/episodes/stage_picture.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::evaluation {

/// Object and camera of a picture, for ground-truth perception.
inline sim::PictureView ViewOf(const StagePicture& picture) {
  return {picture.object_id, CameraPose(picture.taken_from, picture.camera_height_m),
          picture.hfov_deg};
}

}  // namespace crossnav::evaluation
