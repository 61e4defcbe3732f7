// SPDX-License-Identifier: MIT
#include "memory_files.h"

#include <unistd.h>

#include "crossnav/agent/whereabouts.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/scenegraph/build_graph.h"
#include "session.h"

namespace crossnav::app {

Result<store::LoadedMemory> ReadMemory(const std::filesystem::path& path,
                                       const evaluation::RunConfig& config,
                                       const std::string& encoder) {
  const auto header = store::ReadMapHeader(path);
  if (!header) return tl::unexpected(header.error());
  if (auto ok = CheckEncoder(*header, encoder, path.string()); !ok)
    return tl::unexpected(ok.error());
  store::LoadOptions options;
  options.map = config.agent.map;
  // Agent::Restore gives the evidence counts where it has none.
  if (agent::ClearsOldSurfaces(config.agent)) options.map->clearing = header->clearing;
  options.fusion = config.agent.fusion;
  return store::LoadMemory(path, options);
}

Result<void> RestoreMemory(const std::filesystem::path& path, const evaluation::RunConfig& config,
                           const std::string& encoder, agent::Agent& agent) {
  auto loaded = ReadMemory(path, config, encoder);
  if (!loaded) return tl::unexpected(loaded.error());
  auto restored = agent.Restore(std::move(loaded->map), std::move(loaded->memory),
                                std::move(loaded->flights), loaded->seen_stairs);
  if (!restored) return restored;
  agent.RestoreObjects(std::move(loaded->objects), static_cast<int>(loaded->header.revision));
  return {};
}

Result<std::optional<store::LoadedMemory>> MemoryLoader::LostIn() {
  if (is_pose_known_) return std::nullopt;
  auto loaded = ReadMemory(path_, config_, encoder_);
  if (!loaded) return tl::unexpected(loaded.error());
  return std::optional<store::LoadedMemory>(std::move(*loaded));
}

Result<store::SaveReport> SaveMemoryOf(const agent::Agent& agent, const std::filesystem::path& path,
                                       const std::string& encoder, const std::string& frame) {
  store::SaveInfo info;
  info.encoder_name = encoder;
  info.frame = frame;
  info.flights = agent.flights();
  info.seen_stairs = agent.seen_stairs();
  info.objects = agent.objects();
  if (!info.objects.empty())
    LocateRecords(scenegraph::BuildGraph(agent.map(), agent.memory(), info.flights), info.objects);
  return store::SaveMemory(path, agent.map(), agent.memory(), info);
}

Result<std::unique_ptr<MemoryLoader>> KnownMemories::For(
    const evaluation::SceneContext& context) const {
  namespace fs = std::filesystem;
  if (!IsOn()) return std::unique_ptr<MemoryLoader>();
  const fs::path path =
      folder_ / (context.scene().id + "-" + evaluation::ConfigHash(config_).substr(0, 8) + "-" +
                 evaluation::HexHash(context.scene().mesh_hash).substr(0, 8) + ".map");
  std::error_code error;
  if (!fs::exists(path, error)) {
    auto survey = evaluation::SurveyScene(context, config_, known_);
    if (!survey) return tl::unexpected(survey.error());
    fs::create_directories(folder_, error);
    fs::path part = path;
    // of this worker; another worker may make the same file
    part += "." + std::to_string(getpid());
    store::SaveInfo info;
    info.encoder_name = encoder_;
    info.frame = "ground truth of " + context.scene().id;
    info.flights = std::move(survey->flights);
    info.seen_stairs = std::move(survey->seen_stairs);
    const auto saved = store::SaveMemory(part, survey->map, survey->memory, info);
    if (!saved) return tl::unexpected(saved.error());
    fs::rename(part, path, error);
    if (error) return Fail(ErrorCode::kIo, error.message(), path.string());
  }
  return std::make_unique<MemoryLoader>(path, config_, encoder_);
}

}  // namespace crossnav::app
