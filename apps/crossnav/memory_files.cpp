// SPDX-License-Identifier: MIT
#include "memory_files.h"

#include "session.h"

namespace crossnav::app {

Result<void> RestoreMemory(const std::filesystem::path& path, const bench::RunConfig& config,
                           const std::string& encoder, agent::Agent& agent) {
  const auto header = store::ReadMapHeader(path);
  if (!header) return tl::unexpected(header.error());
  if (auto ok = CheckEncoder(*header, encoder, path.string()); !ok) return ok;
  store::LoadOptions options;
  options.map = config.agent.map;
  options.fusion = config.agent.fusion;
  auto loaded = store::LoadMemory(path, options);
  if (!loaded) return tl::unexpected(loaded.error());
  return agent.Restore(std::move(loaded->map), std::move(loaded->memory),
                       std::move(loaded->flights), loaded->seen_stairs);
}

Result<store::SaveReport> SaveMemoryOf(const agent::Agent& agent, const std::filesystem::path& path,
                                       const std::string& encoder, const std::string& frame) {
  store::SaveInfo info;
  info.encoder_name = encoder;
  info.frame = frame;
  info.flights = agent.flights();
  info.seen_stairs = agent.seen_stairs();
  return store::SaveMemory(path, agent.map(), agent.memory(), info);
}

}  // namespace crossnav::app
