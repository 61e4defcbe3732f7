// SPDX-License-Identifier: MIT
#include "eval_prepare.h"

#include <fmt/format.h>

#include <sstream>

#include "crossnav/evaluation/running/worker_pool.h"

namespace crossnav::app {
namespace {

/// The episodes of one scene, as indices.
struct SceneEpisodes {
  std::string scene_id;
  std::vector<std::size_t> indices;
};

std::vector<SceneEpisodes> ScenesOf(const std::vector<evaluation::Episode>& episodes) {
  std::vector<SceneEpisodes> scenes;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    if (scenes.empty() || scenes.back().scene_id != episodes[i].scene_id) {
      scenes.push_back({episodes[i].scene_id, {}});  // episodes are grouped by scene
    }
    scenes.back().indices.push_back(i);
  }
  return scenes;
}

/// In a worker: mesh hash, navmesh hash, and the stage of the first transition of each episode.
Result<std::string> CheckScene(SceneCache& cache, const SceneEpisodes& scene,
                               const std::vector<evaluation::Episode>& episodes) {
  const auto context = cache.Get(scene.scene_id);
  if (!context) {
    Error error = context.error();
    error.what = episodes[scene.indices.front()].where + ": scene_id: " + error.what;
    return tl::unexpected(error);
  }
  const evaluation::SceneHashes hashes = HashesOf(**context);
  std::string text = hashes.mesh_hash + " " + hashes.navmesh_hash;
  for (const std::size_t i : scene.indices) {
    const auto playable = evaluation::CheckPlayable(**context, episodes[i]);
    const bool fits = playable || playable.error().code != ErrorCode::kMismatch;
    if (!playable && fits) return tl::unexpected(playable.error());
    evaluation::Episode certified = episodes[i];
    if (fits && !certified.has_certificate) evaluation::Certify(**context, certified);
    text += fmt::format(" {}", certified.first_transition_stage);
  }
  return text;
}

void Note(const std::string& text, const SceneEpisodes& scene,
          std::vector<evaluation::Episode>& episodes, evaluation::RunHeader& header) {
  std::istringstream stream(text);
  evaluation::SceneHashes& hashes = header.scenes[evaluation::SceneName(scene.scene_id)];
  stream >> hashes.mesh_hash >> hashes.navmesh_hash;
  for (const std::size_t i : scene.indices) {
    stream >> episodes[i].first_transition_stage;
    episodes[i].cross_floor_required = episodes[i].first_transition_stage > 0;
  }
}

}  // namespace

Result<void> PrepareEval(SceneCache& cache, int jobs, std::vector<evaluation::Episode>& episodes,
                         evaluation::RunHeader& header, Console& console) {
  const std::vector<SceneEpisodes> scenes = ScenesOf(episodes);
  std::map<int, Error> errors;
  int done = 0;
  evaluation::PoolTask task;
  task.count = static_cast<int>(scenes.size());
  task.jobs = jobs;
  task.work = [&](int item) {
    return CheckScene(cache, scenes[static_cast<std::size_t>(item)], episodes);
  };
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    const SceneEpisodes& scene = scenes[static_cast<std::size_t>(item)];
    console.Progress(fmt::format("checked scene {} of {}", ++done, scenes.size()));
    if (answer.end == evaluation::ItemEnd::kDone) {
      Note(answer.text, scene, episodes, header);
      return {};
    }
    Error error = answer.error;
    if (answer.end == evaluation::ItemEnd::kCrash) error.where = scene.scene_id;
    errors.emplace(item, std::move(error));
    return {};
  };
  if (auto ok = evaluation::RunPool(task); !ok) return ok;
  console.EndProgress();
  if (!errors.empty()) return tl::unexpected(errors.begin()->second);  // the first error
  return {};
}

}  // namespace crossnav::app
