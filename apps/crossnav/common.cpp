// SPDX-License-Identifier: MIT
#include "commands.h"
#include "crossnav/bench/config_file.h"

namespace crossnav::app {

Result<bench::RunConfig> LoadConfig(const CommonOptions& options, const std::string& variant) {
  bench::RunConfig config;
  if (!options.config_file.empty()) {
    if (auto ok = bench::ApplyConfigFile(options.config_file, config); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  if (auto ok = bench::ApplyVariant(variant, config); !ok) return tl::unexpected(ok.error());
  if (auto ok = bench::ApplyOverrides(options.overrides, config); !ok) {
    return tl::unexpected(ok.error());
  }
  return config;
}

}  // namespace crossnav::app
