// SPDX-License-Identifier: MIT
// An agent's memory from and to a map file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "crossnav/agent/agent.h"
#include "crossnav/bench/run_config.h"
#include "crossnav/bench/runner.h"
#include "crossnav/bench/survey.h"
#include "crossnav/core/result.h"
#include "crossnav/store/map_file.h"

namespace crossnav::app {

/// Gives an agent that has not stepped yet the memory saved at `path`. Errors: features of another
/// encoder than `encoder`, what LoadMemory and Agent::Restore refuse.
Result<void> RestoreMemory(const std::filesystem::path& path, const bench::RunConfig& config,
                           const std::string& encoder, agent::Agent& agent);

/// `frame`: what the world frame is, in words.
Result<store::SaveReport> SaveMemoryOf(const agent::Agent& agent, const std::filesystem::path& path,
                                       const std::string& encoder, const std::string& frame);

/// Gives an agent a saved memory before its first goal: the lifelong case.
class MemoryLoader : public bench::RunObserver {
 public:
  MemoryLoader(std::filesystem::path path, const bench::RunConfig& config, std::string encoder)
      : path_(std::move(path)), config_(config), encoder_(std::move(encoder)) {}

  Result<void> OnStart(agent::Agent& state) override {
    return RestoreMemory(path_, config_, encoder_, state);
  }

 private:
  std::filesystem::path path_;
  const bench::RunConfig& config_;
  std::string encoder_;
};

/// Memories that the variants known-map and known-objects start from: ground truth, a file for each
/// scene in `folder`, made when it is first asked for (bench/survey.h).
class KnownMemories {
 public:
  /// `config` must outlive it.
  KnownMemories(std::filesystem::path folder, const std::string& variant,
                const bench::RunConfig& config, std::string encoder)
      : folder_(std::move(folder)),
        known_(bench::KnownOf(variant)),
        config_(config),
        encoder_(std::move(encoder)) {}

  bool IsOn() const { return known_ != bench::Known::kNothing; }
  /// Null where the variant is told nothing.
  Result<std::unique_ptr<MemoryLoader>> For(const bench::SceneContext& context) const;

 private:
  std::filesystem::path folder_;
  bench::Known known_;
  const bench::RunConfig& config_;
  std::string encoder_;
};

}  // namespace crossnav::app
