// SPDX-License-Identifier: MIT
// An agent's memory from and to a map file.
#pragma once

#include <filesystem>
#include <string>

#include "crossnav/agent/agent.h"
#include "crossnav/bench/run_config.h"
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

}  // namespace crossnav::app
