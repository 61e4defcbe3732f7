// SPDX-License-Identifier: MIT
// Loads and saves an agent's memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "crossnav/agent/agent.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/running/survey.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/store/map_file.h"

namespace crossnav::app {

/// Loads the memory saved at `path` into an agent before its first step. Errors: features of
/// another encoder than `encoder`, errors of LoadMemory and Agent::Restore.
Result<void> RestoreMemory(const std::filesystem::path& path, const evaluation::RunConfig& config,
                           const std::string& encoder, agent::Agent& agent);

/// `frame`: name of the world frame, free text.
Result<store::SaveReport> SaveMemoryOf(const agent::Agent& agent, const std::filesystem::path& path,
                                       const std::string& encoder, const std::string& frame);

/// Loads a saved memory into an agent before its first goal: the lifelong case.
class MemoryLoader : public evaluation::RunObserver {
 public:
  MemoryLoader(std::filesystem::path path, const evaluation::RunConfig& config, std::string encoder)
      : path_(std::move(path)), config_(config), encoder_(std::move(encoder)) {}

  Result<void> OnStart(agent::Agent& state) override {
    return RestoreMemory(path_, config_, encoder_, state);
  }

 private:
  std::filesystem::path path_;
  const evaluation::RunConfig& config_;
  std::string encoder_;
};

/// Memories of the variants known-map and known-objects: ground truth, a file for each scene in
/// `folder`, made on first use (evaluation/running/survey.h).
class KnownMemories {
 public:
  /// `config` must outlive it.
  KnownMemories(std::filesystem::path folder, const std::string& variant,
                const evaluation::RunConfig& config, std::string encoder)
      : folder_(std::move(folder)),
        known_(evaluation::KnownOf(variant)),
        config_(config),
        encoder_(std::move(encoder)) {}

  bool IsOn() const { return known_ != evaluation::Known::kNothing; }
  /// Null if the variant starts without knowledge.
  Result<std::unique_ptr<MemoryLoader>> For(const evaluation::SceneContext& context) const;

 private:
  std::filesystem::path folder_;
  evaluation::Known known_;
  const evaluation::RunConfig& config_;
  std::string encoder_;
};

}  // namespace crossnav::app
