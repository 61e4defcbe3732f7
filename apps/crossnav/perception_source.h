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

#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/inference/suite.h"

namespace crossnav::app {

/// networks.dir, or the folder `networks` that lies beside the program's source or installation.
std::filesystem::path NetworksDir(const evaluation::RunConfig& config);

/// Retrieval thresholds in the card of networks.encoder; nothing in them with ground truth, or
/// where the card cannot be read (PerceptionSource::Read says why).
inference::ModelCard::Retrieval RetrievalOf(const evaluation::RunConfig& config);

/// Puts them in place of each query.* setting that has its default.
void UseRetrieval(evaluation::RunConfig& config);

class PerceptionSource {
 public:
  /// Reads cards and hashes files where networks are asked for; opens none, so that processes can
  /// be forked afterwards. `config` must outlive it; `file_dirs` as in NetworkSet::Read.
  static Result<PerceptionSource> Read(const evaluation::RunConfig& config,
                                       const std::vector<std::filesystem::path>& file_dirs = {});

  /// For RunEpisode.
  evaluation::MakePerception Maker() const;
  /// The networks that answer; nothing where ground truth does.
  std::optional<Result<perception::PerceptionSuite>> MakeSuite() const;
  /// SHA-256 of the networks' files by name; none for ground truth.
  std::map<std::string, std::string> Hashes() const;
  /// Of the features in memories that are made with it.
  std::string EncoderName() const;

 private:
  explicit PerceptionSource(const evaluation::RunConfig& config) : config_(&config) {}
  const evaluation::RunConfig* config_;
  std::shared_ptr<inference::NetworkSet> networks_;  // null = ground truth
};

}  // namespace crossnav::app
