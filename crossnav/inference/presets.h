// SPDX-License-Identifier: MIT
// Sets of networks under one name (docs/networks.md, "Presets").
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "crossnav/inference/networks_config.h"

namespace crossnav::inference {

struct Preset {
  const char* name;
  const char* what;  ///< purpose, for users
  const char* detector;
  const char* segmenter;
  const char* stairs;
  const char* encoder;
};

std::span<const Preset> Presets();
/// nullptr for an unknown name.
const Preset* FindPreset(std::string_view name);

bool IsSame(const Preset& preset, const NetworksConfig& config);

/// The first missing file of `preset`; nullopt if none is missing. `dir` and `file_dirs` as in
/// NetworkSet::Read.
std::optional<std::filesystem::path> MissingFile(
    const Preset& preset, const std::filesystem::path& dir,
    const std::vector<std::filesystem::path>& file_dirs = {});

}  // namespace crossnav::inference
