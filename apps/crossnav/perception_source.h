// SPDX-License-Identifier: MIT
// Where detections come from, as the settings say: ground truth, or networks that are opened when
// the first episode is played.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/bench/run_config.h"
#include "crossnav/bench/runner.h"
#include "crossnav/networks/suite.h"

namespace crossnav::app {

/// networks.dir, or the folder `networks` that lies beside the program's source or installation.
std::filesystem::path NetworksDir(const bench::RunConfig& config);

class PerceptionSource {
 public:
  /// Reads cards and hashes files where networks are asked for; opens none, so that processes can
  /// be forked afterwards. `config` must outlive it; `file_dirs` as in NetworkSet::Read.
  static Result<PerceptionSource> Read(const bench::RunConfig& config,
                                       const std::vector<std::filesystem::path>& file_dirs = {});

  /// For RunEpisode.
  bench::MakePerception Maker() const;
  /// The networks that answer; nothing where ground truth does.
  std::optional<Result<perception::PerceptionSuite>> MakeSuite() const;
  /// SHA-256 of the networks' files by name; none for ground truth.
  std::map<std::string, std::string> Hashes() const;
  /// Of the features in memories that are made with it.
  std::string EncoderName() const;

 private:
  explicit PerceptionSource(const bench::RunConfig& config) : config_(&config) {}
  const bench::RunConfig* config_;
  std::shared_ptr<networks::NetworkSet> networks_;  // null = ground truth
};

}  // namespace crossnav::app
