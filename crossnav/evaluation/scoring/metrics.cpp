// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/metrics.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/check.h"

namespace crossnav::evaluation {
namespace {

double PathRatio(double shortest_m, double length_m) {
  const double longer = std::max(shortest_m, length_m);
  return longer > 0 ? shortest_m / longer : 1.0;
}

/// Habitat's SoftSPL of one stage: progress towards the goal times path efficiency.
std::optional<double> StageSoftSpl(const StageRecord& stage) {
  if (stage.success) return PathRatio(stage.shortest_m, stage.length_m);
  if (!stage.extra.distance_to_goal_m) return std::nullopt;
  if (stage.shortest_m <= 0) return 0.0;
  const double progress = std::max(0.0, 1 - *stage.extra.distance_to_goal_m / stage.shortest_m);
  return progress * PathRatio(stage.shortest_m, stage.length_m);
}

/// Sums over episodes; Finish turns them into shares.
struct Sums {
  Metrics m;
  double soft_spl = 0, distance_m = 0;
  int executed = 0;
  bool has_soft_spl = true, has_distance = true;
};

void AddExecutedStages(const EpisodeRecord& episode, Sums& sums) {
  const double goals = static_cast<double>(episode.goals.size());
  for (const StageRecord& stage : episode.stages) {
    ++sums.executed;
    const auto soft = StageSoftSpl(stage);
    sums.has_soft_spl = sums.has_soft_spl && soft.has_value();
    sums.soft_spl += soft.value_or(0) / goals;
    const auto distance = stage.extra.distance_to_goal_m;
    sums.has_distance = sums.has_distance && distance.has_value();
    sums.distance_m += distance.value_or(0);
  }
}

void AddEpisode(const EpisodeRecord& episode, Sums& sums) {
  const double goals = static_cast<double>(episode.goals.size());
  const int completed = episode.Completed();
  const bool is_complete = completed == static_cast<int>(episode.goals.size());
  double prefix_shortest_m = 0, prefix_length_m = 0, stage_spl = 0;
  for (int k = 0; k <= completed && k < static_cast<int>(episode.goals.size()); ++k) {
    ++sums.m.reached[k];
    if (k == completed) break;
    const StageRecord& stage = episode.stages[k];
    sums.m.sr_global[k] += 1;
    sums.m.spl_global[k] += StageSpl(stage);
    stage_spl += StageSpl(stage) / goals;
    prefix_shortest_m += stage.shortest_m;
    prefix_length_m += stage.length_m;
  }
  const double ratio = completed > 0 ? PathRatio(prefix_shortest_m, prefix_length_m) : 0;
  sums.m.pr += completed / goals;
  sums.m.ppl += completed / goals * ratio;
  sums.m.onemap_stage_spl += stage_spl;
  if (is_complete) {
    sums.m.sr += 1;
    sums.m.spl += ratio;
    sums.m.onemap_episode_spl += stage_spl;
  }
  AddExecutedStages(episode, sums);
}

bool Near(double a, double b) {
  return std::abs(a - b) <= 1e-9;
}

/// eq:conditional_global_relation, and PR and SR as functions of the global stage figures.
void CheckIdentities(const Metrics& m, bool has_uniform_goals) {
  double previous = 1, mean_sr = 0;
  for (int k = 0; k < m.goals; ++k) {
    const double sr_cond = m.sr_conditional[k].value_or(0);
    const double spl_cond = m.spl_conditional[k].value_or(0);
    if (has_uniform_goals) {
      CROSSNAV_CHECK(Near(m.sr_global[k], previous * sr_cond), "SR_global_k != SR_global_k-1 cond");
      CROSSNAV_CHECK(Near(m.spl_global[k], previous * spl_cond), "SPL_global_k != SR_global cond");
    }
    previous = m.sr_global[k];
    mean_sr += m.sr_global[k] / m.goals;
  }
  if (!has_uniform_goals) return;
  CROSSNAV_CHECK(Near(m.pr, mean_sr), "PR is not the mean of SR_global_k");
  CROSSNAV_CHECK(Near(m.sr, m.sr_global.back()), "SR is not SR_global_K");
}

Metrics Finish(Sums sums) {
  Metrics& m = sums.m;
  const double n = m.episodes;
  for (double* value : {&m.sr, &m.spl, &m.pr, &m.ppl, &m.onemap_stage_spl, &m.onemap_episode_spl}) {
    *value /= n;
  }
  m.sr_conditional.resize(m.goals);
  m.spl_conditional.resize(m.goals);
  for (int k = 0; k < m.goals; ++k) {
    if (m.reached[k] > 0) {
      m.sr_conditional[k] = m.sr_global[k] / m.reached[k];
      m.spl_conditional[k] = m.spl_global[k] / m.reached[k];
    }
    m.sr_global[k] /= n;
    m.spl_global[k] /= n;
  }
  if (sums.has_soft_spl && sums.executed > 0) m.soft_spl = sums.soft_spl / n;
  if (sums.has_distance && sums.executed > 0) {
    m.distance_to_goal_m = sums.distance_m / sums.executed;
  }
  return m;
}

template <class Access>
Metrics ComputeOver(int count, const Access& episode_at) {
  Sums sums;
  sums.m.episodes = count;
  if (count == 0) return sums.m;
  bool has_uniform_goals = true;
  for (int i = 0; i < count; ++i) {
    const int goals = static_cast<int>(episode_at(i).goals.size());
    CROSSNAV_CHECK(goals > 0, "an episode without goals");
    has_uniform_goals = has_uniform_goals && (i == 0 || goals == sums.m.goals);
    sums.m.goals = std::max(sums.m.goals, goals);
  }
  sums.m.reached.resize(sums.m.goals);
  sums.m.sr_global.resize(sums.m.goals);
  sums.m.spl_global.resize(sums.m.goals);
  for (int i = 0; i < count; ++i) AddEpisode(episode_at(i), sums);
  Metrics metrics = Finish(std::move(sums));
  CheckIdentities(metrics, has_uniform_goals);
  return metrics;
}

}  // namespace

double StageSpl(const StageRecord& stage) {
  return stage.success ? PathRatio(stage.shortest_m, stage.length_m) : 0.0;  // eq:per_goal_spl
}

Metrics ComputeMetrics(std::span<const EpisodeRecord> episodes) {
  return ComputeOver(static_cast<int>(episodes.size()),
                     [&](int i) -> const EpisodeRecord& { return episodes[i]; });
}

Metrics ComputeMetricsOf(std::span<const EpisodeRecord> episodes, std::span<const int> indices) {
  return ComputeOver(static_cast<int>(indices.size()),
                     [&](int i) -> const EpisodeRecord& { return episodes[indices[i]]; });
}

namespace {

/// Goals of one category share a row; so do all descriptions, and all pictures.
std::string RowOf(const std::string& goal) {
  const GoalKind kind = KindOf(goal);
  return kind == GoalKind::kCategory ? goal : std::string(NameOf(kind));
}

}  // namespace

OutcomeTable CountOutcomes(std::span<const EpisodeRecord> episodes) {
  OutcomeTable table;
  for (const EpisodeRecord& episode : episodes) {
    for (const StageRecord& stage : episode.stages) {
      ++table[RowOf(stage.goal)][static_cast<std::size_t>(stage.outcome)];
    }
  }
  return table;
}

std::vector<EpisodeRecord> JudgedEpisodes(std::span<const EpisodeRecord> episodes) {
  std::vector<EpisodeRecord> judged;
  for (const EpisodeRecord& episode : episodes) {
    if (!episode.failed || episode.failed->reason != kInvalidEpisode) judged.push_back(episode);
  }
  return judged;
}

std::map<std::string, int> CountFailures(std::span<const EpisodeRecord> episodes) {
  std::map<std::string, int> reasons;
  for (const EpisodeRecord& episode : episodes) {
    if (episode.failed) ++reasons[episode.failed->reason];
  }
  return reasons;
}

std::map<std::string, CategoryMetrics> PerCategory(std::span<const EpisodeRecord> episodes) {
  std::map<std::string, CategoryMetrics> categories;
  for (const EpisodeRecord& episode : episodes) {
    for (const StageRecord& stage : episode.stages) {
      CategoryMetrics& category = categories[RowOf(stage.goal)];
      ++category.executed;
      category.sr += stage.success ? 1 : 0;
      category.spl += StageSpl(stage);
    }
  }
  for (auto& [name, category] : categories) {
    category.sr /= category.executed;
    category.spl /= category.executed;
  }
  return categories;
}

std::vector<KindMetrics> PerKind(std::span<const EpisodeRecord> episodes) {
  std::vector<KindMetrics> kinds;
  bool is_mixed = false;
  for (const GoalKind kind : kGoalKinds) {
    KindMetrics metrics{kind};
    bool is_asked_for = false;
    for (const EpisodeRecord& episode : episodes) {
      for (const std::string& goal : episode.goals) is_asked_for |= KindOf(goal) == kind;
      for (const StageRecord& stage : episode.stages) {
        if (KindOf(stage.goal) != kind) continue;
        ++metrics.executed;
        metrics.successes += stage.success ? 1 : 0;
        metrics.spl += StageSpl(stage);
      }
    }
    if (!is_asked_for) continue;
    is_mixed |= kind != GoalKind::kCategory;
    if (metrics.executed > 0) metrics.spl /= metrics.executed;
    kinds.push_back(metrics);
  }
  return is_mixed ? kinds : std::vector<KindMetrics>();
}

std::map<std::string, std::vector<EpisodeRecord>> GroupByScene(
    std::span<const EpisodeRecord> episodes) {
  std::map<std::string, std::vector<EpisodeRecord>> groups;
  for (const EpisodeRecord& episode : episodes) groups[episode.scene_id].push_back(episode);
  return groups;
}

std::map<std::string, std::vector<EpisodeRecord>> GroupByTrack(
    std::span<const EpisodeRecord> episodes) {
  std::map<std::string, std::vector<EpisodeRecord>> groups;
  const bool is_known = std::any_of(episodes.begin(), episodes.end(),
                                    [](const EpisodeRecord& e) { return !e.track.empty(); });
  if (!is_known) return groups;
  for (const EpisodeRecord& episode : episodes)
    groups[episode.track.empty() ? "other" : episode.track].push_back(episode);
  return groups;
}

std::map<std::string, std::vector<EpisodeRecord>> GroupByCrossFloor(
    std::span<const EpisodeRecord> episodes) {
  std::map<std::string, std::vector<EpisodeRecord>> groups;
  for (const EpisodeRecord& episode : episodes) {
    groups[episode.cross_floor_required ? "cfr" : "same_floor"].push_back(episode);
    if (episode.cross_floor_required) {
      groups["cfr_first_" + std::to_string(episode.first_transition_stage)].push_back(episode);
    }
  }
  return groups;
}

}  // namespace crossnav::evaluation
