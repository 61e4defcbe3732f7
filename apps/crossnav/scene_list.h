// SPDX-License-Identifier: MIT
// A list of scenes: a text file with one name a line, '#' begins a comment.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::app {

/// Ids of the scenes below `scenes_dir` that the file names, in its order. A name is an id, a
/// folder ("00800-TEEsavR23oF") or the part of it after the number.
Result<std::vector<std::string>> ReadSceneList(const std::string& file,
                                               const std::string& scenes_dir);

}  // namespace crossnav::app
