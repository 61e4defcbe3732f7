// SPDX-License-Identifier: MIT
// Configuration files (TOML) and `key=value` overrides onto a RunConfig. An empty file means "the
// paper". Every problem is reported, not only the first; an unknown key names its nearest
// neighbour.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/settings/run_config.h"

namespace crossnav::evaluation {

/// Applies a TOML file. On error `config` is unchanged; `where` names the file, `what` lists every
/// problem with its key, one a line. Old keys of renamed settings are read; each adds a line to
/// `warnings`.
Result<void> ApplyConfigFile(const std::filesystem::path& path, RunConfig& config,
                             std::vector<std::string>* warnings = nullptr);

/// ApplyConfigFile from text; `name` stands for the file in messages.
Result<void> ApplyConfigText(std::string_view toml, const std::string& name, RunConfig& config,
                             std::vector<std::string>* warnings = nullptr);

/// Applies overrides such as "policy.poi.use_history=false", in order, all or none.
Result<void> ApplyOverrides(const std::vector<std::string>& overrides, RunConfig& config,
                            std::vector<std::string>* warnings = nullptr);

/// A named set of settings; docs/cli.md lists them.
Result<void> ApplyVariant(std::string_view variant, RunConfig& config);

/// All sources of settings, in their order of application.
struct ConfigSources {
  std::filesystem::path file;  ///< empty = none
  std::string variant = "full";
  std::vector<std::string> overrides;
};

/// The defaults, then the settings of the noise profile that the sources name, then the sources.
/// With a profile, `map.clearing` is "evidence" unless a source sets it.
Result<RunConfig> ReadConfig(const ConfigSources& sources,
                             std::vector<std::string>* warnings = nullptr);

/// Defaults with the settings of a noise profile: the base to which the sources are applied again.
RunConfig DefaultsOfProfile(const std::string& profile);

/// The effective configuration, every field, as one JSON object (nested) or as TOML.
std::string DumpJson(const RunConfig& config);
std::string DumpToml(const RunConfig& config);

/// 16 hex digits over every key and value; the same on every machine.
std::string ConfigHash(const RunConfig& config);

}  // namespace crossnav::evaluation
