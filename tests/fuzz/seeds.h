// SPDX-License-Identifier: MIT
// Valid inputs to begin with, made by the program's own writers: folder/TARGET/name, a few kB each.
// Checksums are left out where the format allows it, since random changes never hit them.
#pragma once

#include <filesystem>

namespace crossnav::fuzz {

void WriteSeeds(const std::filesystem::path& folder);

}  // namespace crossnav::fuzz
