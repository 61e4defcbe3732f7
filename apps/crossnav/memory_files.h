// SPDX-License-Identifier: MIT
// Loads and saves an agent's memory.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
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

/// Reads the memory saved at `path` for going on with `config`. Errors: features of another encoder
/// than `encoder`, errors of LoadMemory.
Result<store::LoadedMemory> ReadMemory(const std::filesystem::path& path,
                                       const evaluation::RunConfig& config,
                                       const std::string& encoder);

/// Gives an agent a saved memory before its first goal: the lifelong case. With an unknown pose the
/// robot has to find itself in it first.
class MemoryLoader : public evaluation::RunObserver {
 public:
  MemoryLoader(std::filesystem::path path, const evaluation::RunConfig& config, std::string encoder,
               bool is_pose_known = true)
      : path_(std::move(path)),
        config_(config),
        encoder_(std::move(encoder)),
        is_pose_known_(is_pose_known) {}

  Result<void> OnStart(agent::Agent& state) override {
    return is_pose_known_ ? RestoreMemory(path_, config_, encoder_, state) : Result<void>();
  }
  Result<std::optional<store::LoadedMemory>> LostIn() override;
  void OnAwoken(const evaluation::Awoken& awoken) override { awoken_ = awoken; }
  /// Nothing where the pose was known.
  const std::optional<evaluation::Awoken>& awoken() const { return awoken_; }

 private:
  std::filesystem::path path_;
  const evaluation::RunConfig& config_;
  std::string encoder_;
  bool is_pose_known_;
  std::optional<evaluation::Awoken> awoken_;
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
