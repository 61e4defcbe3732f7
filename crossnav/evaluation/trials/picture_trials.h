// SPDX-License-Identifier: MIT
// Pictures of objects of a generated house against a map of all of it: which record is the object
// in the picture, by the agent's own rule (agent/pictured_goal.h)?
#pragma once

#include <string>
#include <vector>

#include "crossnav/agent/pictured_goal.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/settings/run_config.h"

namespace crossnav::evaluation {

/// A record of the category that the picture was read as.
struct PicturePair {
  bool is_same = false;  ///< the record is of the object in the picture
  agent::Likeness likeness;
  double log_odds = 0;
};

struct PictureTrial {
  std::string category, read_as;  ///< true, and as perception has it
  int rivals = 0;                 ///< records of other objects of the category
  bool has_record = false;
  bool is_right = false;  ///< the record with the highest odds is the object's
  std::vector<PicturePair> pairs;
};

struct PictureTrials {
  std::string house;
  std::vector<PictureTrial> trials;
};

/// House `seed` of edition 2, with colours; `each` pictures of every category at most, of objects
/// with a rival in the house and without a twin in the room. `make_perception`: networks; without
/// it, ground truth.
Result<PictureTrials> TryPictures(std::uint64_t seed, int each, const RunConfig& config,
                                  const MakePerception& make_perception = {});

}  // namespace crossnav::evaluation
