// SPDX-License-Identifier: MIT
#include "commands.h"
#include "crossnav/evaluation/settings/config_file.h"

namespace crossnav::app {

Result<evaluation::RunConfig> LoadConfig(const CommonOptions& options, const std::string& variant,
                                         std::vector<std::string>* warnings) {
  return evaluation::ReadConfig({options.config_file, variant, options.overrides}, warnings);
}

}  // namespace crossnav::app
