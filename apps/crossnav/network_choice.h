// SPDX-License-Identifier: MIT
// `--networks`: a preset of networks (docs/networks.md, "Presets").
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands.h"

namespace crossnav::app {

inline constexpr const char* kNetworksHelp =
    "own (the network of the repository), or real (boxes by DEIMv2 Femto); default: real where its "
    "file is there and no setting names a network";

/// The settings of `common` with the networks of `preset`. Overrides of `common` take precedence.
/// Empty preset: `real` if no setting names a network and its files exist. `file_dirs` as in
/// NetworkSet::Read. Error: a missing file of the preset.
Result<evaluation::RunConfig> LoadWithNetworks(
    const CommonOptions& common, const std::string& preset,
    const std::vector<std::filesystem::path>& file_dirs = {});

/// "networks: real (boxes deimv2_femto_coco, ...)".
std::string NetworksText(const inference::NetworksConfig& config);

}  // namespace crossnav::app
