// SPDX-License-Identifier: MIT
#include "commands.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "perception_source.h"

namespace crossnav::app {

Result<evaluation::RunConfig> LoadConfig(const CommonOptions& options, const std::string& variant,
                                         std::vector<std::string>* warnings) {
  auto config = evaluation::ReadConfig({options.config_file, variant, options.overrides}, warnings);
  if (config) UseCards(*config);
  return config;
}

}  // namespace crossnav::app
