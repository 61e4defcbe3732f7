// SPDX-License-Identifier: MIT
// The networks that a configuration names, as a perception suite. Cards are read first, so that
// what is wrong is said before anything runs; files are opened when a suite is made, once a
// process.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "crossnav/networks/networks_config.h"
#include "crossnav/networks/parts.h"
#include "crossnav/perception/perception.h"

namespace crossnav::networks {

/// Paths of all cards (*.toml) in a folder, sorted by name.
Result<std::vector<std::filesystem::path>> ListCards(const std::filesystem::path& dir);

class NetworkSet {
 public:
  /// Reads the cards that `config` names, below `dir`, and hashes their files. An empty name is a
  /// part that is left out. Opens no network:
  /// this may be called before processes are forked. Errors: a card, a part that its family lacks,
  /// a file that is not there or not the card's.
  static Result<NetworkSet> Read(const NetworksConfig& config, const std::filesystem::path& dir);

  /// A suite over networks that are opened at the first call. One suite at a time. Parts that are
  /// left out are null, which an agent cannot do with: see IsComplete.
  Result<perception::PerceptionSuite> MakeSuite(double camera_height_m);

  /// An error that names the first part that is left out.
  Result<void> IsComplete() const;

  /// SHA-256 of each file that is used, by name of its card.
  const std::map<std::string, std::string>& hashes() const { return hashes_; }
  /// As the suite's encoder will be called.
  const std::string& encoder_name() const { return encoder_name_; }

 private:
  Result<void> HashFiles(const ModelCard& card);
  Result<Model*> ModelOf(const std::string& name, const ModelOptions& options);

  NetworksConfig config_;
  std::map<std::string, ModelCard> cards_;
  std::map<std::string, std::string> hashes_;
  std::string encoder_name_;
  std::map<std::string, std::shared_ptr<Model>> models_;
};

}  // namespace crossnav::networks
