// SPDX-License-Identifier: MIT
#include "commands.h"
#include "crossnav/bench/config_file.h"

namespace crossnav::app {

Result<bench::RunConfig> LoadConfig(const CommonOptions& options, const std::string& variant,
                                    std::vector<std::string>* warnings) {
  return bench::ReadConfig({options.config_file, variant, options.overrides}, warnings);
}

}  // namespace crossnav::app
