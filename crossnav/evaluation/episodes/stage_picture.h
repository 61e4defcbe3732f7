// SPDX-License-Identifier: MIT
// Goals of episodes that are pictures. World frame; on disk Habitat's (habitat_frame.h).
#pragma once

#include <map>
#include <memory>
#include <string>

#include "crossnav/core/pose.h"
#include "crossnav/perception/perception.h"

namespace crossnav::evaluation {

/// A goal's picture. The agent gets `picture`; the rest is for the evaluator and for ground-truth
/// perception.
struct StagePicture {
  perception::GoalPicture picture;
  int object_id = 0;           ///< instance that it shows
  AgentPose taken_from;        ///< foot of the camera; it is level
  double camera_height_m = 0;  ///< above the foot
  double hfov_deg = 0;
};

/// By perception::NameOfPicture.
using StagePictures = std::map<std::string, std::shared_ptr<const StagePicture>>;

}  // namespace crossnav::evaluation
