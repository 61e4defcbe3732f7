// SPDX-License-Identifier: MIT
// The benchmark's metrics, from episode records alone (paper, "Post-hoc Multi-Object Evaluation
// Protocol": eq:posthoc_distance to eq:conditional_global_relation). All values are shares in
// [0, 1] unless the name has a unit. Pure functions; bootstrap intervals are seeded.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/records/goal_kind.h"

namespace crossnav::evaluation {

struct Metrics {
  int episodes = 0;
  int goals = 0;  ///< K, the longest goal list
  // Sequence level (MultiON): m = completed prefix.
  double sr = 0, spl = 0, pr = 0, ppl = 0;
  // Per stage k = 0 .. K-1.
  std::vector<int> reached;  ///< episodes that reached stage k
  std::vector<double> sr_global, spl_global;
  std::vector<std::optional<double>> sr_conditional, spl_conditional;  ///< empty where reached = 0
  // Names keep these apart from the figures above.
  double onemap_stage_spl = 0;     ///< OneMap: mean over stages of SPL_k, unexecuted stages 0
  double onemap_episode_spl = 0;   ///< OneMap: the same, of completed episodes only
  std::optional<double> soft_spl;  ///< mean over stages of (1 - D/d*) d*/max(d*, l)
  std::optional<double> distance_to_goal_m;  ///< mean over executed stages, at their end
};

/// SPL_k = s_k d*_k / max(d*_k, l_k) (eq:per_goal_spl); 1 for a success without a path.
double StageSpl(const StageRecord& stage);

/// Aborts if the identities of eq:conditional_global_relation do not hold. Empty input: all zero.
Metrics ComputeMetrics(std::span<const EpisodeRecord> episodes);
/// Metrics of a selection, repeats allowed (bootstrap).
Metrics ComputeMetricsOf(std::span<const EpisodeRecord> episodes, std::span<const int> indices);

/// Row = goal category, or the kind of other goals; column = outcome. Sorted by name.
using OutcomeTable = std::map<std::string, std::array<int, kOutcomeNames.size()>>;
OutcomeTable CountOutcomes(std::span<const EpisodeRecord> episodes);

/// Without episodes that do not fit their scene: they cannot be played and count in no figure.
std::vector<EpisodeRecord> JudgedEpisodes(std::span<const EpisodeRecord> episodes);

/// Episodes without a result, by reason (error, crash, time). They count as not successful.
std::map<std::string, int> CountFailures(std::span<const EpisodeRecord> episodes);

/// Stage-level figures of one goal category, or of the other goals of one kind: share of success
/// and mean SPL over executed stages.
struct CategoryMetrics {
  int executed = 0;
  double sr = 0, spl = 0;
};
std::map<std::string, CategoryMetrics> PerCategory(std::span<const EpisodeRecord> episodes);

/// Stage-level figures of one kind of goal (goal_kind.h), over executed stages.
struct KindMetrics {
  GoalKind kind = GoalKind::kCategory;
  int executed = 0, successes = 0;
  double spl = 0;
};
/// Of each kind that was asked for; empty where all goals are categories.
std::vector<KindMetrics> PerKind(std::span<const EpisodeRecord> episodes);

/// Episodes grouped by scene id, and by "cfr" / "same_floor" / "cfr_first_<k>".
std::map<std::string, std::vector<EpisodeRecord>> GroupByScene(
    std::span<const EpisodeRecord> episodes);
std::map<std::string, std::vector<EpisodeRecord>> GroupByCrossFloor(
    std::span<const EpisodeRecord> episodes);

/// By EpisodeRecord::track; empty where no record names one.
std::map<std::string, std::vector<EpisodeRecord>> GroupByTrack(
    std::span<const EpisodeRecord> episodes);

struct Interval {
  double low = 0, high = 0;
};

/// Wilson's 95 % interval of a share, `hits` of `trials`; [0, 1] without trials.
Interval WilsonInterval(int hits, int trials);

/// A figure of a set of episodes; empty where it is undefined (e.g. no episode reached the stage).
using Statistic = std::function<std::optional<double>(const Metrics&)>;

/// All figures of a report under their names: SR, SPL, PR, PPL, SR_cond_1, ...
std::vector<std::pair<std::string, Statistic>> NamedStatistics(int goals);

/// Percentile bootstrap over episodes, 95 %, `resamples` draws. Empty where the figure is
/// undefined.
struct BootstrapConfig {
  int resamples = 1000;
  std::uint64_t seed = 1;
};
std::map<std::string, Interval> BootstrapIntervals(std::span<const EpisodeRecord> episodes,
                                                   const BootstrapConfig& config);

/// Difference b - a of two runs on the same episodes, resampled in pairs: whole scenes are drawn,
/// because episodes of a scene are alike; single episodes if there is only one scene.
struct PairedDifference {
  double difference = 0;
  Interval interval;
};
/// `a` and `b` hold the same episode ids in the same order (checked).
std::map<std::string, PairedDifference> ComparePaired(std::span<const EpisodeRecord> a,
                                                      std::span<const EpisodeRecord> b,
                                                      const BootstrapConfig& config);

}  // namespace crossnav::evaluation
