// SPDX-License-Identifier: MIT
#pragma once

#include "crossnav/evaluation/episodes/stage_picture.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::evaluation {

/// What ground-truth perception needs of a picture.
inline sim::PictureView ViewOf(const StagePicture& picture) {
  return {picture.object_id, CameraPose(picture.taken_from, picture.camera_height_m),
          picture.hfov_deg};
}

}  // namespace crossnav::evaluation
