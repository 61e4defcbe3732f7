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

/// Applies a TOML file. On error `config` is unchanged; `where` names the file, `what` every
/// problem with its key, one a line. Old keys of renamed settings are read; each adds a line to
/// `warnings`.
Result<void> ApplyConfigFile(const std::filesystem::path& path, RunConfig& config,
                             std::vector<std::string>* warnings = nullptr);

/// As ApplyConfigFile from text; `name` stands for the file in messages.
Result<void> ApplyConfigText(std::string_view toml, const std::string& name, RunConfig& config,
                             std::vector<std::string>* warnings = nullptr);

/// Applies overrides such as "policy.poi.use_history=false", in order, all or none.
Result<void> ApplyOverrides(const std::vector<std::string>& overrides, RunConfig& config,
                            std::vector<std::string>* warnings = nullptr);

/// A named set of settings; docs/cli.md lists them.
Result<void> ApplyVariant(std::string_view variant, RunConfig& config);

/// Everything a user may say of settings, in the order in which it is applied.
struct ConfigSources {
  std::filesystem::path file;  ///< empty = none
  std::string variant = "full";
  std::vector<std::string> overrides;
};

/// The defaults, those of the noise profile that the sources name, then the sources. Under a
/// profile `map.clearing` is "evidence" unless a source says otherwise.
Result<RunConfig> ReadConfig(const ConfigSources& sources,
                             std::vector<std::string>* warnings = nullptr);

/// `config` with the settings that its noise profile stands for: what to apply the sources to again
/// where they named a profile.
RunConfig DefaultsOfProfile(const std::string& profile);

/// The effective configuration, every field, as one JSON object (nested) or as TOML.
std::string DumpJson(const RunConfig& config);
std::string DumpToml(const RunConfig& config);

/// 16 hex digits over every key and value; the same on every machine.
std::string ConfigHash(const RunConfig& config);

}  // namespace crossnav::evaluation
