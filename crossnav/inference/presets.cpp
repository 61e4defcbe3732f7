// SPDX-License-Identifier: MIT
#include "crossnav/inference/presets.h"

#include <algorithm>
#include <array>
#include <system_error>

#include "crossnav/inference/suite.h"

namespace crossnav::inference {
namespace {

constexpr std::array<Preset, 2> kPresets = {
    {{"own", "the network of the repository alone: trained on renders", "crossnav_small",
      "crossnav_small", "crossnav_small", "crossnav_small"},
     {"real", "real cameras: boxes by DEIMv2 Femto, trained on photographs", "deimv2_femto_coco",
      "depth", "crossnav_small", "crossnav_small"}}};

}  // namespace

std::span<const Preset> Presets() {
  return kPresets;
}

const Preset* FindPreset(std::string_view name) {
  const auto found = std::find_if(kPresets.begin(), kPresets.end(),
                                  [&](const Preset& preset) { return preset.name == name; });
  return found == kPresets.end() ? nullptr : &*found;
}

bool IsSame(const Preset& preset, const NetworksConfig& config) {
  return config.detector == preset.detector && config.segmenter == preset.segmenter &&
         config.stairs == preset.stairs && config.encoder == preset.encoder;
}

std::optional<std::filesystem::path> MissingFile(
    const Preset& preset, const std::filesystem::path& dir,
    const std::vector<std::filesystem::path>& file_dirs) {
  std::error_code error;
  for (const char* name : {preset.detector, preset.segmenter, preset.stairs, preset.encoder}) {
    if (std::string_view(name) == kDepthSegmenter) continue;
    auto card = ReadModelCard(CardPath(dir, name));
    if (!card) return CardPath(dir, name);
    FindFile(*card, file_dirs);
    if (!std::filesystem::exists(card->file, error)) return card->file;
  }
  return std::nullopt;
}

}  // namespace crossnav::inference
