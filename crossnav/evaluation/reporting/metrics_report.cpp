// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/metrics_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/scoring/cause.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

bool IsShare(const std::string& name) {
  return name != "distance_to_goal_m";
}

std::string FigureText(const std::string& name, double value) {
  return IsShare(name) ? fmt::format("{:6.2f}", 100 * value) : fmt::format("{:6.2f}", value);
}

/// {name: {value, low, high}} of one set of records.
Json FiguresJson(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap) {
  const Metrics metrics = ComputeMetrics(episodes);
  const auto intervals = BootstrapIntervals(episodes, bootstrap);
  Json figures = Json::object();
  for (const auto& [name, statistic] : NamedStatistics(metrics.goals)) {
    const auto value = statistic(metrics);
    if (!value) {
      figures[name] = nullptr;
      continue;
    }
    figures[name] = {{"value", *value}};
    const auto interval = intervals.find(name);
    if (interval == intervals.end()) continue;
    figures[name]["low"] = interval->second.low;
    figures[name]["high"] = interval->second.high;
  }
  return figures;
}

Json GroupJson(const std::vector<EpisodeRecord>& episodes, const BootstrapConfig& bootstrap) {
  return {{"episodes", episodes.size()}, {"metrics", FiguresJson(episodes, bootstrap)}};
}

std::string FiguresText(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap) {
  const Metrics metrics = ComputeMetrics(episodes);
  const auto intervals = BootstrapIntervals(episodes, bootstrap);
  std::string text;
  for (const auto& [name, statistic] : NamedStatistics(metrics.goals)) {
    const auto value = statistic(metrics);
    if (!value) {
      text += fmt::format("  {:<20}      -\n", name);
      continue;
    }
    text += fmt::format("  {:<20} {}", name, FigureText(name, *value));
    const auto interval = intervals.find(name);
    if (interval != intervals.end()) {
      text += fmt::format("  [{}, {}]", FigureText(name, interval->second.low),
                          FigureText(name, interval->second.high));
    }
    text += "\n";
  }
  return text;
}

std::string GroupLine(const std::string& name, std::span<const EpisodeRecord> episodes) {
  const Metrics m = ComputeMetrics(episodes);
  return fmt::format("  {:<24} {:5}  {:6.2f} {:6.2f} {:6.2f} {:6.2f}\n", name, m.episodes,
                     100 * m.sr, 100 * m.spl, 100 * m.pr, 100 * m.ppl);
}

std::string OutcomeText(const OutcomeTable& table) {
  std::string text = fmt::format("  {:<12} {:>6}", "goal", "total");
  for (const std::string_view name : kOutcomeNames) text += fmt::format(" {:>12}", name);
  text += "\n";
  for (const auto& [goal, counts] : table) {
    int total = 0;
    for (const int count : counts) total += count;
    text += fmt::format("  {:<12} {:>6}", goal, total);
    for (const int count : counts) text += fmt::format(" {:>12}", count);
    text += "\n";
  }
  return text;
}

/// "failed: 1 crash, 2 time; they count as not successful", or empty.
std::string FailuresText(std::span<const EpisodeRecord> episodes) {
  std::string reasons;
  for (const auto& [reason, count] : CountFailures(episodes)) {
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  }
  if (reasons.empty()) return {};
  return "failed: " + reasons + "; they count as not successful\n";
}

/// Success by kind of goal, where goals are not all categories.
std::string KindsText(std::span<const EpisodeRecord> episodes) {
  const auto kinds = PerKind(episodes);
  if (kinds.empty()) return {};
  std::string text = fmt::format("\n  {:<12} {:>6} {:>6}  {:<16} {:>6}\n", "kind of goal", "n",
                                 "SR", "95 % (Wilson)", "SPL");
  for (const KindMetrics& kind : kinds) {
    const Interval interval = WilsonInterval(kind.successes, kind.executed);
    text += fmt::format("  {:<12} {:>6} {:6.2f}  [{:6.2f}, {:6.2f}] {:6.2f}\n", NameOf(kind.kind),
                        kind.executed, 100.0 * kind.successes / std::max(1, kind.executed),
                        100 * interval.low, 100 * interval.high, 100 * kind.spl);
  }
  return text;
}

Json KindsJson(std::span<const EpisodeRecord> episodes) {
  Json kinds = Json::object();
  for (const KindMetrics& kind : PerKind(episodes)) {
    const Interval interval = WilsonInterval(kind.successes, kind.executed);
    kinds[std::string(NameOf(kind.kind))] = {
        {"executed", kind.executed},
        {"sr", static_cast<double>(kind.successes) / std::max(1, kind.executed)},
        {"low", interval.low},
        {"high", interval.high},
        {"spl", kind.spl}};
  }
  return kinds;
}

/// Text for records of one origin.
std::string TrackText(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap) {
  std::string text =
      fmt::format("{} episodes; per cent, with bootstrap 95 % intervals\n", episodes.size());
  text += FailuresText(episodes);
  text += FiguresText(episodes, bootstrap);
  text += fmt::format("\n  {:<24} {:>5}  {:>6} {:>6} {:>6} {:>6}\n", "group", "n", "SR", "SPL",
                      "PR", "PPL");
  for (const auto& [name, group] : GroupByCrossFloor(episodes)) text += GroupLine(name, group);
  for (const auto& [name, group] : GroupByScene(episodes)) {
    text += GroupLine(name.empty() ? "(no scene)" : name, group);
  }
  text += fmt::format("\n  {:<12} {:>6} {:>6} {:>6}\n", "goal", "n", "SR", "SPL");
  for (const auto& [name, category] : PerCategory(episodes)) {
    text += fmt::format("  {:<12} {:>6} {:6.2f} {:6.2f}\n", name, category.executed,
                        100 * category.sr, 100 * category.spl);
  }
  return text + KindsText(episodes) + "\n" + OutcomeText(CountOutcomes(episodes));
}

Json TrackJson(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap) {
  const Metrics metrics = ComputeMetrics(episodes);
  Json groups = Json::object(), scenes = Json::object(), categories = Json::object();
  for (const auto& [name, group] : GroupByCrossFloor(episodes)) {
    groups[name] = GroupJson(group, bootstrap);
  }
  for (const auto& [name, group] : GroupByScene(episodes)) {
    scenes[name] = GroupJson(group, bootstrap);
  }
  for (const auto& [name, category] : PerCategory(episodes)) {
    categories[name] = {
        {"executed", category.executed}, {"sr", category.sr}, {"spl", category.spl}};
  }
  Json outcomes = Json::object();
  for (const auto& [goal, counts] : CountOutcomes(episodes)) {
    Json row = Json::object();
    for (std::size_t i = 0; i < counts.size(); ++i) row[std::string(kOutcomeNames[i])] = counts[i];
    outcomes[goal] = std::move(row);
  }
  Json json = {{"episodes", metrics.episodes},      {"goals", metrics.goals},
               {"failed", CountFailures(episodes)}, {"metrics", FiguresJson(episodes, bootstrap)},
               {"reached", metrics.reached},        {"groups", std::move(groups)},
               {"scenes", std::move(scenes)},       {"categories", std::move(categories)},
               {"outcomes", std::move(outcomes)}};
  if (Json kinds = KindsJson(episodes); !kinds.empty()) json["kinds"] = std::move(kinds);
  return json;
}

}  // namespace

std::string MetricsText(std::span<const EpisodeRecord> all, const BootstrapConfig& bootstrap) {
  const std::vector<EpisodeRecord> episodes = JudgedEpisodes(all);
  if (const std::size_t invalid = all.size() - episodes.size(); invalid > 0) {
    return fmt::format("invalid: {} episodes do not fit their scenes; no figure counts them\n",
                       invalid) +
           MetricsText(episodes, bootstrap);
  }
  if (episodes.empty()) return "no episodes\n";
  const auto tracks = GroupByTrack(episodes);
  if (tracks.size() < 2) {
    return (tracks.empty() ? "" : "track " + tracks.begin()->first + ": ") +
           TrackText(episodes, bootstrap);
  }
  std::string text;
  for (const auto& [name, group] : tracks)
    text += (text.empty() ? "track " : "\ntrack ") + name + ": " + TrackText(group, bootstrap);
  return text;
}

std::string MetricsJson(std::span<const EpisodeRecord> all, const BootstrapConfig& bootstrap) {
  const std::vector<EpisodeRecord> episodes = JudgedEpisodes(all);
  const auto tracks = GroupByTrack(episodes);
  if (tracks.size() < 2) {
    Json json = TrackJson(episodes, bootstrap);
    if (!tracks.empty()) json["track"] = tracks.begin()->first;
    if (all.size() > episodes.size()) json["invalid"] = all.size() - episodes.size();
    return json.dump(1);
  }
  Json by_name = Json::object();
  for (const auto& [name, group] : tracks) by_name[name] = TrackJson(group, bootstrap);
  return Json({{"episodes", episodes.size()}, {"tracks", std::move(by_name)}}).dump(1);
}

std::string EpisodeText(const EpisodeRecord& record) {
  std::string text =
      fmt::format("{}: {} of {} goals, {} actions, {:.1f} s\n", record.episode_id,
                  record.Completed(), record.goals.size(), record.actions, record.wall_s);
  text += fmt::format("  {:<12} {:<13} {:>8} {:>9} {:>8} {:>6} {:>7}\n", "goal", "outcome",
                      "actions", "length m", "d* m", "SPL", "floors");
  for (const StageRecord& stage : record.stages) {
    text += fmt::format("  {:<12} {:<13} {:>8} {:>9.2f} {:>8.2f} {:>6.3f} {:>4} > {}\n", stage.goal,
                        NameOf(stage.outcome), stage.actions, stage.length_m, stage.shortest_m,
                        StageSpl(stage), stage.floor_start, stage.floor_end);
  }
  if (record.failed) {
    text += fmt::format("  failed ({}): {}\n", record.failed->reason, record.failed->message);
  }
  for (const std::string& line : CauseLines(record)) text += "  " + line + "\n";
  const Metrics m = ComputeMetrics({&record, 1});
  return text +
         fmt::format("  SR {:.0f}  SPL {:.3f}  PR {:.3f}  PPL {:.3f}\n", m.sr, m.spl, m.pr, m.ppl);
}

}  // namespace crossnav::evaluation
