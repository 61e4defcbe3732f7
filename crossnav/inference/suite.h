// SPDX-License-Identifier: MIT
// The configured networks as a perception suite. Cards are read first, so that errors appear before
// anything runs; files are opened when a suite is made, once a process.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/inference/networks_config.h"
#include "crossnav/inference/parts.h"
#include "crossnav/perception/perception.h"

namespace crossnav::inference {

inline constexpr std::string_view kDepthSegmenter = "depth";  ///< the segmenter without a file

/// "crossnav_small" -> dir/crossnav_small.toml; a path of a card stays unchanged.
std::filesystem::path CardPath(const std::filesystem::path& dir, const std::string& name);

/// Folders of network files that are not beside their cards: the folder in CROSSNAV_NETWORKS, then
/// crossnav/networks in $XDG_DATA_HOME (~/.local/share).
std::vector<std::filesystem::path> FileDirs();

/// If `card.file` is not beside its card, points it to the file of that name in `dirs` or
/// FileDirs().
void FindFile(ModelCard& card, const std::vector<std::filesystem::path>& dirs = {});

/// Paths of all cards (*.toml) in a folder, sorted by name.
Result<std::vector<std::filesystem::path>> ListCards(const std::filesystem::path& dir);

class NetworkSet {
 public:
  /// Reads the cards that `config` names, below `dir`, and hashes their files. An empty name omits
  /// the part. Opens no network, so that it may be called before a fork. Errors: a card, a part
  /// that its family lacks, a missing file or a file with another hash. Files that are not beside
  /// their cards are searched in `file_dirs` and FileDirs().
  static Result<NetworkSet> Read(const NetworksConfig& config, const std::filesystem::path& dir,
                                 const std::vector<std::filesystem::path>& file_dirs = {});

  /// A suite over networks, which are opened at the first call. One suite at a time; with
  /// `networks.batch` > 1 any number, each of which may run in a thread of its own (batcher.h). Not
  /// thread-safe itself. Omitted parts are null, and an agent needs all: see IsComplete.
  Result<perception::PerceptionSuite> MakeSuite(double camera_height_m);

  /// Whether an agent can use it. Errors: the first omitted part, or no inference library.
  Result<void> IsComplete() const;

  /// SHA-256 of each file in use, by name of its card.
  const std::map<std::string, std::string>& hashes() const { return hashes_; }
  /// Name of the suite's encoder.
  const std::string& encoder_name() const { return encoder_name_; }

 private:
  Result<void> HashFiles(const ModelCard& card);
  Result<Model*> ModelOf(const std::string& name, const ModelOptions& options);

  NetworksConfig config_;
  std::map<std::string, ModelCard> cards_;
  std::map<std::string, std::string> hashes_;
  std::string encoder_name_;
  std::map<std::string, std::shared_ptr<Model>> models_;
  std::shared_ptr<SharedNetworks> shared_;  // null = one suite at a time
};

}  // namespace crossnav::inference
