// SPDX-License-Identifier: MIT
// Real CLIP text vectors from a folder: `oid_names.txt` (a name a line) and `oid_clip_a+cname.npy`
// (NumPy's format 1, a float16 or float32 row for each name).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::sim {

/// By name in lower case; all of one length, all finite, not normalised.
using NamedVectors = std::map<std::string, std::vector<float>>;

/// Errors name the file.
Result<NamedVectors> ReadClipVectors(const std::filesystem::path& dir);

/// "TV_monitor " -> "tv monitor"
std::string SpacedName(std::string_view text);

}  // namespace crossnav::sim
