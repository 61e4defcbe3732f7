// SPDX-License-Identifier: MIT
// Source of detections according to the settings: ground truth, or networks, which are opened when
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

/// networks.dir, or the folder `networks` beside the program's source or installation.
std::filesystem::path NetworksDir(const evaluation::RunConfig& config);

/// Retrieval thresholds in the card of networks.encoder; nothing in them with ground truth, or
/// where the card cannot be read (PerceptionSource::Read says why).
inference::ModelCard::Retrieval RetrievalOf(const evaluation::RunConfig& config);

/// Puts measured numbers of the encoder's and the detector's card in place of each query.* and
/// verify.* setting that has its default.
void UseCards(evaluation::RunConfig& config);

class PerceptionSource {
 public:
  /// Reads cards and hashes files if networks are configured; opens none, so that processes can be
  /// forked afterwards. `config` must outlive it; `file_dirs` as in NetworkSet::Read.
  static Result<PerceptionSource> Read(const evaluation::RunConfig& config,
                                       const std::vector<std::filesystem::path>& file_dirs = {});

  /// For RunEpisode.
  evaluation::MakePerception Maker() const;
  /// The configured networks; empty for ground truth.
  std::optional<Result<perception::PerceptionSuite>> MakeSuite() const;
  /// SHA-256 of the networks' files by name; empty for ground truth.
  std::map<std::string, std::string> Hashes() const;
  /// Encoder of the features in memories made with it.
  std::string EncoderName() const;

 private:
  explicit PerceptionSource(const evaluation::RunConfig& config) : config_(&config) {}
  const evaluation::RunConfig* config_;
  std::shared_ptr<inference::NetworkSet> networks_;  // null = ground truth
};

}  // namespace crossnav::app
