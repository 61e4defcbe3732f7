// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/generation/episode_generator.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/core/check.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/scoring/outcome.h"

namespace crossnav::evaluation {
namespace {

constexpr double kRounding_m = 1e-4;  // chosen: files keep 1e-5; ids must survive a round trip

double Rounded(double value) {
  return std::round(value / kRounding_m) * kRounding_m;
}

/// A start on a floor (not on a flight); empty if the drawn point is not on a floor.
std::optional<AgentPose> DrawStart(const SceneContext& context, const DatasetConfig& config,
                                   Rng& rng) {
  const auto p = context.navmesh().RandomPoint(rng);
  const double yaw_rad = DegToRad(rng.Int(0, 359));
  if (!p) return std::nullopt;
  AgentPose start;
  start.p_world = {Rounded(p->x()), Rounded(p->y()), Rounded(p->z())};
  start.yaw_rad = WrapAngle(yaw_rad);
  for (const sim::Floor& floor : context.navmesh().Floors()) {
    if (floor.GapTo(start.p_world.z()) <= config.max_start_step_m) return start;
  }
  return std::nullopt;
}

/// Categories of the scene with at least one viewpoint.
std::vector<std::string> CategoriesOf(const SceneContext& context) {
  std::vector<std::string> categories;
  for (const std::string_view name : kCategories) {
    const std::string category(name);
    if (!context.FloorsOf(category).empty()) categories.push_back(category);
  }
  return categories;
}

std::vector<std::string> DrawGoals(std::vector<std::string> categories, const DatasetConfig& config,
                                   Rng& rng) {
  std::vector<std::string> goals;
  if (config.allow_repeats) {
    for (int k = 0; k < config.goals; ++k) {
      goals.push_back(categories[rng.Below(static_cast<std::uint32_t>(categories.size()))]);
    }
    return goals;
  }
  rng.Shuffle(categories);
  goals.assign(categories.begin(), categories.begin() + config.goals);
  return goals;
}

/// Certified episode from a start and goals; empty if a rule is broken.
std::optional<Episode> TryEpisode(const GeneratorScene& scene, const RunConfig& config,
                                  const AgentPose& start, const std::vector<std::string>& goals) {
  const SceneContext& context = *scene.context;
  Episode episode;
  episode.scene_id = scene.scene_id;
  episode.start = start;
  episode.goals = goals;
  if (!CheckPlayable(context, episode)) return std::nullopt;
  const auto first_m = context.DistanceToGoal(start.p_world, goals[0]);
  if (!first_m || *first_m < config.dataset.min_first_goal_m) return std::nullopt;
  Certify(context, episode);
  episode.episode_id = ContentId(episode);
  if (!CheckCertificate(context, episode, config).empty()) return std::nullopt;
  return episode;
}

/// Requirements of one episode of the file.
struct Wish {
  int index = 0;
  int stage = 0;            ///< of the first transition, 0 = none
  bool is_exact = false;    ///< the caller gave the counts per stage
  bool alternates = false;  ///< every stage requires a floor change; `stage` is 1
};

/// Draws an episode that satisfies the wish from one scene.
std::optional<Episode> DrawEpisode(const GeneratorScene& scene, const RunConfig& config,
                                   const Wish& wish, Rng& rng) {
  const auto categories = CategoriesOf(*scene.context);
  const int needed = config.dataset.allow_repeats ? 1 : config.dataset.goals;
  if (static_cast<int>(categories.size()) < needed) return std::nullopt;
  for (int attempt = 0; attempt < config.dataset.tries_per_episode; ++attempt) {
    const auto start = DrawStart(*scene.context, config.dataset, rng);
    const auto goals = DrawGoals(categories, config.dataset, rng);
    if (!start) continue;
    auto episode = TryEpisode(scene, config, *start, goals);
    if (!episode || episode->first_transition_stage != wish.stage) continue;
    if (!wish.alternates || Alternates(*episode)) return episode;
  }
  return std::nullopt;
}

/// Stage of the first transition of each episode: the given counts per stage, or the share that
/// requires one, evenly spread.
std::vector<int> PlanTransitions(const RunConfig& config, const GeneratorOptions& options,
                                 Rng& rng) {
  std::vector<int> stages;
  for (std::size_t k = 0; k < options.first_transitions.size(); ++k) {
    const auto count = static_cast<std::size_t>(options.first_transitions[k]);
    stages.insert(stages.end(), count, static_cast<int>(k) + 1);
  }
  if (options.first_transitions.empty()) {
    const int required = static_cast<int>(std::lround(options.count * options.cross_floor_share));
    for (int i = 0; i < required; ++i) stages.push_back(1 + i % config.dataset.goals);
  }
  CROSSNAV_CHECK(static_cast<int>(stages.size()) <= options.count,
                 "more transitions than episodes");
  stages.resize(static_cast<std::size_t>(options.count), 0);
  rng.Shuffle(stages);
  return stages;
}

/// Tries the scenes in turn, then the other stages of the same kind where allowed.
std::optional<Episode> DrawFromAnyScene(std::span<const GeneratorScene> scenes,
                                        const RunConfig& config, const Wish& wish, Rng& rng) {
  const int index = wish.index, stage = wish.stage;
  const int choices = stage == 0 || wish.is_exact ? 1 : config.dataset.goals;
  for (int shift = 0; shift < choices; ++shift) {
    Wish from_scene = wish;
    const int wanted = from_scene.stage =
        stage == 0 ? 0 : 1 + (stage - 1 + shift) % config.dataset.goals;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const GeneratorScene& scene = scenes[(index + s) % scenes.size()];
      if (wanted > 0 && scene.context->navmesh().Floors().size() < 2) continue;
      auto episode = DrawEpisode(scene, config, from_scene, rng);
      if (episode) return episode;
    }
  }
  return std::nullopt;
}

tl::unexpected<Error> CannotCertify(int stage, std::size_t number, int count) {
  return Fail(ErrorCode::kInvalid,
              std::string("cannot certify an episode that ") +
                  (stage > 0 ? "requires a floor change" : "stays on one floor") +
                  "; change --cross-floor, --first or --goals, or add scenes",
              "episode " + std::to_string(number) + " of " + std::to_string(count));
}

/// Episodes drawn scene by scene: the finished episodes, and the stages of the open ones.
struct DrawnByScene {
  EpisodeFile file;
  std::set<std::string> ids;
  std::vector<int> open;  // stages of first transitions
};

/// Draws up to `most` of the open episodes in one scene; a stage that fails once is not tried again
/// in that scene.
void DrawHere(const GeneratorScene& scene, const RunConfig& config, std::size_t most, Rng& rng,
              DrawnByScene& drawn) {
  constexpr int kRepeats = 10;  // chosen: draws that repeat an existing episode
  std::set<int> impossible;
  if (scene.context->navmesh().Floors().size() < 2) {
    for (const int stage : drawn.open) {
      if (stage > 0) impossible.insert(stage);
    }
  }
  std::vector<int> left;
  for (const int stage : drawn.open) {
    std::optional<Episode> episode;
    for (int i = 0; i < kRepeats && most > 0 && !impossible.contains(stage); ++i) {
      episode = DrawEpisode(scene, config, {0, stage, true, false}, rng);
      if (!episode || drawn.ids.insert(episode->episode_id).second) break;
      episode.reset();
    }
    if (!episode) {
      if (most > 0) impossible.insert(stage);
      left.push_back(stage);
      continue;
    }
    --most;
    drawn.file.episodes.push_back(std::move(*episode));
  }
  drawn.open = std::move(left);
}

}  // namespace

bool Alternates(const Episode& episode) {
  std::vector<int> before = {episode.start_floor};
  for (const std::vector<int>& floors : episode.certificate) {
    const bool is_shared = std::any_of(floors.begin(), floors.end(), [&](int floor) {
      return std::find(before.begin(), before.end(), floor) != before.end();
    });
    if (is_shared) return false;
    before = floors;
  }
  return true;
}

void AddGoalObjects(const GeneratorScene& scene, EpisodeFile& file) {
  const std::string prefix = std::filesystem::path(scene.scene_id).filename().string() + "_";
  for (const std::string_view name : kCategories) {
    const std::string category(name);
    std::vector<GoalObject> goals;
    for (const Target& target : scene.context->TargetsOf(category)) {
      if (target.viewpoints_world.empty()) continue;
      goals.push_back({target.instance, target.name, category, target.box.Center(),
                       target.viewpoints_world, target.is_confirmable});
    }
    if (!goals.empty()) file.goals_by_category[prefix + category] = std::move(goals);
  }
}

Result<Episode> MakeEpisode(const GeneratorScene& scene, const RunConfig& config,
                            const std::vector<std::string>& goals, int start_floor,
                            std::uint64_t seed) {
  CROSSNAV_CHECK(!goals.empty(), "an episode needs goals");
  Rng rng(seed);
  for (int attempt = 0; attempt < config.dataset.tries_per_episode; ++attempt) {
    const auto start = DrawStart(*scene.context, config.dataset, rng);
    if (!start || scene.context->navmesh().FloorOf(start->p_world) != start_floor) continue;
    if (auto episode = TryEpisode(scene, config, *start, goals)) return *episode;
  }
  return Fail(ErrorCode::kInvalid, "the chosen goals cannot be certified from this floor",
              scene.scene_id);
}

Result<EpisodeFile> GenerateEpisodes(std::span<const GeneratorScene> scenes,
                                     const RunConfig& config, const GeneratorOptions& options) {
  CROSSNAV_CHECK(!scenes.empty(), "no scenes to make episodes for");
  EpisodeFile file;
  Rng rng(options.seed);
  const auto stages = PlanTransitions(config, options, rng);
  std::set<std::string> ids;
  for (int i = 0; i < options.count; ++i) {
    std::optional<Episode> episode;
    for (int again = 0; again < 10; ++again) {
      episode.reset();
      Wish wish{i, stages[static_cast<std::size_t>(i)], !options.first_transitions.empty(), false};
      const bool wants_all = wish.stage > 0 && !wish.is_exact && options.alternating_share > 0 &&
                             rng.Chance(options.alternating_share);
      if (wants_all) {
        const Wish all{i, 1, true, true};
        episode = DrawFromAnyScene(scenes, config, all, rng);
      }
      if (!episode) episode = DrawFromAnyScene(scenes, config, wish, rng);
      if (!episode || ids.insert(episode->episode_id).second) break;
    }
    if (!episode) {
      return CannotCertify(stages[static_cast<std::size_t>(i)], static_cast<std::size_t>(i) + 1,
                           options.count);
    }
    file.episodes.push_back(std::move(*episode));
    options.drawn(i + 1);
  }
  if (config.dataset.certificate == "detection") file.certificate_edition = 2;
  for (const GeneratorScene& scene : scenes) AddGoalObjects(scene, file);
  return file;
}

Result<EpisodeFile> GenerateByScene(std::span<const std::string> scene_ids, const SceneLoader& load,
                                    const RunConfig& config, const GeneratorOptions& options) {
  CROSSNAV_CHECK(!scene_ids.empty(), "no scenes to make episodes for");
  CROSSNAV_CHECK(options.alternating_share == 0, "drawn over all scenes only");
  constexpr std::uint64_t kRounds = 2;
  Rng plan(options.seed);
  DrawnByScene drawn;
  drawn.open = PlanTransitions(config, options, plan);
  for (std::uint64_t round = 0; round < kRounds; ++round) {
    for (std::size_t s = 0; s < scene_ids.size(); ++s) {
      if (round > 0 && drawn.open.empty()) break;
      const auto context = load(scene_ids[s]);
      if (!context) return tl::unexpected(context.error());
      const GeneratorScene scene{scene_ids[s], context->get()};
      if (round == 0) AddGoalObjects(scene, drawn.file);
      const std::size_t scenes_left = round == 0 ? scene_ids.size() - s : 1;
      Rng rng(MixSeed(options.seed, HashString(scene.scene_id) + round));
      DrawHere(scene, config, (drawn.open.size() + scenes_left - 1) / scenes_left, rng, drawn);
      options.drawn(static_cast<int>(drawn.file.episodes.size()));
    }
  }
  if (!drawn.open.empty()) {
    return CannotCertify(drawn.open.front(), drawn.file.episodes.size() + 1, options.count);
  }
  if (config.dataset.certificate == "detection") drawn.file.certificate_edition = 2;
  return std::move(drawn.file);
}

}  // namespace crossnav::evaluation
