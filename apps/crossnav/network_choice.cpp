// SPDX-License-Identifier: MIT
#include "network_choice.h"

#include <fmt/format.h>

#include "crossnav/networks/presets.h"
#include "perception_source.h"

namespace crossnav::app {

Result<bench::RunConfig> LoadWithNetworks(const CommonOptions& common, const std::string& preset,
                                          const std::vector<std::filesystem::path>& file_dirs) {
  CommonOptions all = common;
  const networks::Preset* asked = networks::FindPreset(preset);
  if (asked != nullptr)
    all.overrides.insert(all.overrides.begin(),
                         {fmt::format("networks.detector=\"{}\"", asked->detector),
                          fmt::format("networks.segmenter=\"{}\"", asked->segmenter),
                          fmt::format("networks.stairs=\"{}\"", asked->stairs),
                          fmt::format("networks.encoder=\"{}\"", asked->encoder)});
  auto config = LoadConfig(all);
  if (!config) return config;
  const auto dir = NetworksDir(*config);
  if (asked != nullptr && networks::IsSame(*asked, config->networks)) {
    if (const auto missing = networks::MissingFile(*asked, dir, file_dirs))
      return Fail(ErrorCode::kNotFound,
                  fmt::format("is not there, and --networks {} needs it: put it there, or name its "
                              "folder in CROSSNAV_NETWORKS; --networks own does without",
                              preset),
                  missing->string());
  }
  const networks::Preset& real = *networks::FindPreset("real");
  const bool is_default = networks::IsSame(*networks::FindPreset("own"), config->networks);
  if (asked == nullptr && is_default && !networks::MissingFile(real, dir, file_dirs))
    networks::Apply(real, config->networks);
  return config;
}

std::string NetworksText(const networks::NetworksConfig& config) {
  std::string name = "of the settings";
  for (const networks::Preset& preset : networks::Presets())
    if (networks::IsSame(preset, config)) name = preset.name;
  return fmt::format("networks: {} (boxes {}, masks {}, stairs {}, features {})", name,
                     config.detector, config.segmenter, config.stairs, config.encoder);
}

}  // namespace crossnav::app
