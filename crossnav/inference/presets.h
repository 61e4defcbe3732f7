// SPDX-License-Identifier: MIT
// Networks that are chosen together by one name (docs/networks.md, "Presets").
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
  const char* what;  ///< it is for
  const char* detector;
  const char* segmenter;
  const char* stairs;
  const char* encoder;
};

std::span<const Preset> Presets();
/// nullptr where there is none of this name.
const Preset* FindPreset(std::string_view name);

void Apply(const Preset& preset, NetworksConfig& config);
bool IsSame(const Preset& preset, const NetworksConfig& config);

/// The first file that a network of `preset` lacks; nullopt where all are there. `dir` and
/// `file_dirs` as in NetworkSet::Read.
std::optional<std::filesystem::path> MissingFile(
    const Preset& preset, const std::filesystem::path& dir,
    const std::vector<std::filesystem::path>& file_dirs = {});

}  // namespace crossnav::inference
