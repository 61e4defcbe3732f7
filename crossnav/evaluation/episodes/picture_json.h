// SPDX-License-Identifier: MIT
// "goal_pictures" of an episode file. Internal to the reader.
#pragma once

#include <simdjson.h>

#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/episodes/episodes.h"

namespace crossnav::evaluation {

/// Reads the pictures of a file's root and gives each episode those of its goals. Each must be a
/// PNG within the limits of perception/goal_picture.h with the content that its name says. Errors
/// name file and picture, or the episode whose picture is missing.
Result<void> ReadGoalPictures(simdjson::dom::object root, const std::string& where,
                              std::vector<Episode>& episodes);

}  // namespace crossnav::evaluation
