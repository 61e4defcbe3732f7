// SPDX-License-Identifier: MIT
#include "session.h"

#include <algorithm>

#include <fmt/format.h>

#include "crossnav/core/version.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"

namespace crossnav::app {

Result<evaluation::RunConfig> LoadRunConfig(const CommonOptions& common, const Protocol& protocol) {
  CommonOptions all = common;
  if (!protocol.success.empty()) all.overrides.push_back("eval.success=" + protocol.success);
  if (!protocol.budget_scope.empty()) {
    all.overrides.push_back("eval.budget_scope=" + protocol.budget_scope);
  }
  if (!protocol.perception.empty()) {
    all.overrides.push_back("eval.perception=" + protocol.perception);
  }
  auto config = LoadConfig(all, protocol.variant);
  if (!config) return config;
  if (auto ok = sim::CheckGroundTruthEncoder(config->ground_truth); !ok)
    return tl::unexpected(ok.error());
  return config;
}

Result<const evaluation::SceneContext*> SceneCache::Get(const std::string& scene_id) {
  for (const Entry& entry : entries_) {
    if (entry.scene_id == scene_id) return entry.context.get();
  }
  if (entries_.size() >= keep_) entries_.erase(entries_.begin());
  auto context = evaluation::SceneContext::Load(scenes_dir_, scene_id, config_);
  if (!context) return tl::unexpected(context.error());
  if (file_ != nullptr && file_->format == evaluation::EpisodeFormat::kObjectNav)
    (*context)->UseGoals(file_->goals_by_category, scene_id);
  if (file_ != nullptr && file_->certificate_edition > 1)
    (*context)->UseMarks(file_->goals_by_category, scene_id);
  if (file_ != nullptr) (*context)->UseInstanceGoals(file_->goals_by_category, scene_id);
  entries_.push_back({scene_id, std::move(*context)});
  return entries_.back().context.get();
}

Result<std::vector<evaluation::GeneratorScene>> SceneCache::GetAll(
    const std::vector<std::string>& ids, Console& console) {
  keep_ = std::max(keep_, entries_.size() + ids.size());
  std::vector<evaluation::GeneratorScene> scenes;
  for (const std::string& id : ids) {
    console.Progress(fmt::format("scene {} of {}: {}", scenes.size() + 1, ids.size(), id));
    const auto context = Get(id);
    if (!context) return tl::unexpected(context.error());
    for (const std::string& note : (*context)->scene().notes) console.Log(id + ": " + note);
    scenes.push_back({id, *context});
  }
  return scenes;
}

evaluation::RunHeader MakeHeader(const evaluation::RunConfig& config, const std::string& variant,
                                 const evaluation::EpisodeFile& file) {
  evaluation::RunHeader header;
  header.variant = variant;
  header.config_json = evaluation::DumpJson(config);
  header.config_hash = evaluation::ConfigHash(config);
  header.episodes_hash = evaluation::HexHash(file.content_hash);
  header.episodes = static_cast<int>(file.episodes.size());
  header.seed = config.eval.seed;
  header.version = CROSSNAV_VERSION;
  header.perception = config.eval.perception + "-perception";
  return header;
}

evaluation::SceneHashes HashesOf(const evaluation::SceneContext& context) {
  return {evaluation::HexHash(context.scene().mesh_hash),
          evaluation::HexHash(context.navmesh().Hash())};
}

Result<void> CheckEncoder(const store::MapHeader& header, const std::string& encoder,
                          const std::string& path) {
  if (header.feature_dim == 0 || header.encoder_name.empty() || header.encoder_name == encoder)
    return {};
  const char* remedy = "; it was made with eval.perception = networks and that network";
  if (header.encoder_name == "ground-truth-clip")
    remedy = "; set ground_truth.clip_dir to the folder of CLIP vectors";
  if (header.encoder_name == "ground-truth") remedy = "; leave ground_truth.clip_dir empty";
  return Fail(ErrorCode::kMismatch,
              "its features are of encoder \"" + header.encoder_name + "\", not \"" + encoder +
                  "\"" + remedy,
              path);
}

Result<evaluation::Episode> FindEpisode(const evaluation::EpisodeFile& file, const std::string& id,
                                        const std::string& path) {
  for (const evaluation::Episode& episode : file.episodes) {
    if (episode.episode_id == id) return episode;
  }
  std::string some;
  for (std::size_t i = 0; i < std::min<std::size_t>(file.episodes.size(), 3); ++i) {
    some += (i ? ", " : "; there are ") + file.episodes[i].episode_id;
  }
  return Fail(ErrorCode::kNotFound, "no episode \"" + id + "\"" + some, path);
}

}  // namespace crossnav::app
