// SPDX-License-Identifier: MIT
// Old keys of renamed settings. An old key is read for one version, with a warning.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace crossnav::evaluation {

/// Translates the keys of one source: a configuration file, or all overrides together.
class RenamedSettings {
 public:
  explicit RenamedSettings(std::string source) : source_(std::move(source)) {}

  /// The present key of `key`. An old key adds a warning; an old and the present key of one setting
  /// in one source add a problem.
  std::string PresentKey(const std::string& key);

  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::string source_;
  std::map<std::string, std::string> given_;  ///< present key -> key as given first
  std::vector<std::string> warnings_, problems_;
};

}  // namespace crossnav::evaluation
