// SPDX-License-Identifier: MIT
#include "network_choice.h"

#include <fmt/format.h>

#include "crossnav/inference/presets.h"
#include "perception_source.h"

namespace crossnav::app {

Result<evaluation::RunConfig> LoadWithNetworks(
    const CommonOptions& common, const std::string& preset,
    const std::vector<std::filesystem::path>& file_dirs) {
  CommonOptions all = common;
  const inference::Preset* asked = inference::FindPreset(preset);
  const auto use = [&](const inference::Preset& networks) {
    all.overrides.insert(all.overrides.begin(),
                         {fmt::format("networks.detector=\"{}\"", networks.detector),
                          fmt::format("networks.segmenter=\"{}\"", networks.segmenter),
                          fmt::format("networks.stairs=\"{}\"", networks.stairs),
                          fmt::format("networks.encoder=\"{}\"", networks.encoder)});
  };
  if (asked != nullptr) use(*asked);
  auto config = LoadConfig(all);
  if (!config) return config;
  const auto dir = NetworksDir(*config);
  if (asked != nullptr && inference::IsSame(*asked, config->networks)) {
    if (const auto missing = inference::MissingFile(*asked, dir, file_dirs))
      return Fail(ErrorCode::kNotFound,
                  fmt::format("is not there, and --networks {} needs it: put it there, or name its "
                              "folder in CROSSNAV_NETWORKS; --networks own does without",
                              preset),
                  missing->string());
  }
  const inference::Preset& real = *inference::FindPreset("real");
  const bool is_default = inference::IsSame(*inference::FindPreset("own"), config->networks);
  if (asked != nullptr || !is_default || inference::MissingFile(real, dir, file_dirs))
    return config;
  use(real);
  return LoadConfig(all);  // with the numbers of its cards
}

std::string NetworksText(const inference::NetworksConfig& config) {
  std::string name = "of the settings";
  for (const inference::Preset& preset : inference::Presets())
    if (inference::IsSame(preset, config)) name = preset.name;
  return fmt::format("networks: {} (boxes {}, masks {}, stairs {}, features {})", name,
                     config.detector, config.segmenter, config.stairs, config.encoder);
}

}  // namespace crossnav::app
