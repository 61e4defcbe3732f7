// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crossnav/core/check.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {
namespace {

Statistic Field(double Metrics::*field) {
  return [field](const Metrics& m) -> std::optional<double> { return m.*field; };
}

template <class T>
Statistic StageField(std::vector<T> Metrics::*field, int k) {
  return [field, k](const Metrics& m) -> std::optional<double> {
    if (k >= static_cast<int>((m.*field).size())) return std::nullopt;
    return (m.*field)[k];
  };
}

/// Value at `share` of the sorted sample, nearest rank.
double Percentile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(position))];
}

std::optional<Interval> IntervalOf(std::vector<double> sample) {
  if (sample.empty()) return std::nullopt;
  std::sort(sample.begin(), sample.end());
  return Interval{Percentile(sample, 0.025), Percentile(sample, 0.975)};
}

std::vector<int> Resample(Rng& rng, int n) {
  std::vector<int> indices(n);
  for (int& index : indices) index = static_cast<int>(rng.Below(static_cast<std::uint32_t>(n)));
  return indices;
}

/// Indices of the episodes of each scene, by scene.
std::vector<std::vector<int>> SceneMembers(std::span<const EpisodeRecord> episodes) {
  std::map<std::string, std::vector<int>> scenes;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    scenes[episodes[i].scene_id].push_back(static_cast<int>(i));
  }
  std::vector<std::vector<int>> members;
  for (auto& [scene, indices] : scenes) members.push_back(std::move(indices));
  return members;
}

/// Draws as many scenes as there are, each with all its episodes.
std::vector<int> ResampleScenes(Rng& rng, const std::vector<std::vector<int>>& scenes) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto& drawn = scenes[rng.Below(static_cast<std::uint32_t>(scenes.size()))];
    indices.insert(indices.end(), drawn.begin(), drawn.end());
  }
  return indices;
}

}  // namespace

Interval WilsonInterval(int hits, int trials) {
  if (trials <= 0) return {0, 1};
  constexpr double kZ = 1.959964;  // 95 %
  const double n = trials, p = hits / n, zz = kZ * kZ;
  const double middle = (p + zz / (2 * n)) / (1 + zz / n);
  const double half = kZ * std::sqrt(p * (1 - p) / n + zz / (4 * n * n)) / (1 + zz / n);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::vector<std::pair<std::string, Statistic>> NamedStatistics(int goals) {
  std::vector<std::pair<std::string, Statistic>> all = {{"SR", Field(&Metrics::sr)},
                                                        {"SPL", Field(&Metrics::spl)},
                                                        {"PR", Field(&Metrics::pr)},
                                                        {"PPL", Field(&Metrics::ppl)}};
  for (int k = 0; k < goals; ++k) {
    const std::string suffix = std::string("_") + std::to_string(k + 1);
    all.emplace_back("SR_cond" + suffix, StageField(&Metrics::sr_conditional, k));
    all.emplace_back("SPL_cond" + suffix, StageField(&Metrics::spl_conditional, k));
    all.emplace_back("SR_global" + suffix, StageField(&Metrics::sr_global, k));
    all.emplace_back("SPL_global" + suffix, StageField(&Metrics::spl_global, k));
  }
  all.emplace_back("onemap_stage_SPL", Field(&Metrics::onemap_stage_spl));
  all.emplace_back("onemap_episode_SPL", Field(&Metrics::onemap_episode_spl));
  all.emplace_back("soft_SPL", [](const Metrics& m) { return m.soft_spl; });
  all.emplace_back("distance_to_goal_m", [](const Metrics& m) { return m.distance_to_goal_m; });
  return all;
}

std::map<std::string, Interval> BootstrapIntervals(std::span<const EpisodeRecord> episodes,
                                                   const BootstrapConfig& config) {
  if (episodes.empty()) return {};
  const auto statistics = NamedStatistics(ComputeMetrics(episodes).goals);
  std::vector<std::vector<double>> samples(statistics.size());
  Rng rng(config.seed);
  for (int r = 0; r < config.resamples; ++r) {
    const auto indices = Resample(rng, static_cast<int>(episodes.size()));
    const Metrics metrics = ComputeMetricsOf(episodes, indices);
    for (std::size_t s = 0; s < statistics.size(); ++s) {
      if (const auto value = statistics[s].second(metrics)) samples[s].push_back(*value);
    }
  }
  std::map<std::string, Interval> intervals;
  for (std::size_t s = 0; s < statistics.size(); ++s) {
    if (const auto interval = IntervalOf(samples[s])) intervals[statistics[s].first] = *interval;
  }
  return intervals;
}

std::map<std::string, PairedDifference> ComparePaired(std::span<const EpisodeRecord> a,
                                                      std::span<const EpisodeRecord> b,
                                                      const BootstrapConfig& config) {
  CROSSNAV_CHECK(a.size() == b.size(), "paired runs need the same episodes");
  for (std::size_t i = 0; i < a.size(); ++i) {
    CROSSNAV_CHECK(a[i].episode_id == b[i].episode_id, "paired runs need the same episode order");
  }
  if (a.empty()) return {};
  const Metrics all_a = ComputeMetrics(a), all_b = ComputeMetrics(b);
  const auto statistics = NamedStatistics(std::max(all_a.goals, all_b.goals));
  std::vector<std::vector<double>> samples(statistics.size());
  const auto scenes = SceneMembers(a);
  Rng rng(config.seed);
  for (int r = 0; r < config.resamples; ++r) {
    const auto indices =
        scenes.size() > 1 ? ResampleScenes(rng, scenes) : Resample(rng, static_cast<int>(a.size()));
    const Metrics metrics_a = ComputeMetricsOf(a, indices),
                  metrics_b = ComputeMetricsOf(b, indices);
    for (std::size_t s = 0; s < statistics.size(); ++s) {
      const auto value_a = statistics[s].second(metrics_a);
      const auto value_b = statistics[s].second(metrics_b);
      if (value_a && value_b) samples[s].push_back(*value_b - *value_a);
    }
  }
  std::map<std::string, PairedDifference> differences;
  for (std::size_t s = 0; s < statistics.size(); ++s) {
    const auto value_a = statistics[s].second(all_a), value_b = statistics[s].second(all_b);
    const auto interval = IntervalOf(samples[s]);
    if (!value_a || !value_b || !interval) continue;
    differences[statistics[s].first] = {*value_b - *value_a, *interval};
  }
  return differences;
}

}  // namespace crossnav::evaluation
