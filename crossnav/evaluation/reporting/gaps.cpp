// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/gaps.h"

#include <algorithm>
#include <map>
#include <set>

#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

/// The episodes of `run` whose id is in `ids`, by id.
std::vector<EpisodeRecord> Only(const ReportRun& run, const std::set<std::string>& ids) {
  std::vector<EpisodeRecord> episodes;
  for (const EpisodeRecord& episode : run.episodes) {
    if (ids.contains(episode.episode_id)) episodes.push_back(episode);
  }
  SortRecords(episodes);
  return episodes;
}

/// Ids common to all runs, by track.
std::map<std::string, std::set<std::string>> CommonIds(const std::vector<ReportRun>& runs) {
  std::map<std::string, std::size_t> count;
  for (const ReportRun& run : runs) {
    for (const EpisodeRecord& episode : run.episodes) ++count[episode.episode_id];
  }
  std::map<std::string, std::set<std::string>> ids;
  for (const EpisodeRecord& episode : runs.front().episodes) {
    if (count[episode.episode_id] == runs.size()) ids[episode.track].insert(episode.episode_id);
  }
  return ids;
}

StageMeans MeansOf(const std::vector<EpisodeRecord>& episodes) {
  StageMeans means;
  int walks = 0, successes = 0;
  for (const EpisodeRecord& episode : episodes) {
    for (const StageRecord& stage : episode.stages) {
      ++means.stages;
      if (stage.success) {
        ++successes;
        means.shortest_m += stage.shortest_m;
        means.length_m += stage.length_m;
      }
      if (!stage.extra.walk) continue;
      ++walks;
      means.forward += stage.extra.walk->forward;
      means.turn += stage.extra.walk->turn;
      means.look += stage.extra.walk->look;
    }
  }
  for (double* sum : {&means.forward, &means.turn, &means.look}) *sum /= std::max(walks, 1);
  for (double* sum : {&means.shortest_m, &means.length_m}) *sum /= std::max(successes, 1);
  return means;
}

RunGaps GapsOf(const ReportRun& run, const std::vector<EpisodeRecord>& episodes) {
  const Metrics metrics = ComputeMetrics(episodes);
  RunGaps gaps{run.name, run.variant, metrics.sr, metrics.spl, {}, MeansOf(episodes)};
  const double share = 1.0 / static_cast<double>(episodes.size());
  for (const EpisodeRecord& episode : episodes) {
    const GapParts parts = PartsOf(episode);
    gaps.parts.failed += share * parts.failed;
    gaps.parts.detour += share * parts.detour;
    gaps.parts.approach += share * parts.approach;
    gaps.parts.place += share * parts.place;
    gaps.parts.unknown += share * parts.unknown;
  }
  return gaps;
}

Gaps GapsOfTrack(const std::string& track, const std::set<std::string>& ids,
                 const std::vector<ReportRun>& runs, const BootstrapConfig& bootstrap) {
  Gaps gaps;
  gaps.track = track;
  gaps.episodes = static_cast<int>(ids.size());
  std::map<std::string, std::vector<EpisodeRecord>> by_variant;
  for (const ReportRun& run : runs) {
    auto episodes = Only(run, ids);
    gaps.runs.push_back(GapsOf(run, episodes));
    by_variant[run.variant] = std::move(episodes);
  }
  const auto gain = [&](const char* from, const char* to) -> std::optional<PairedDifference> {
    const auto a = by_variant.find(from), b = by_variant.find(to);
    if (a == by_variant.end() || b == by_variant.end()) return std::nullopt;
    return ComparePaired(a->second, b->second, bootstrap).at("SPL");
  };
  gaps.geometry = gain("full", "known-map");
  gaps.search = gain("known-map", "known-objects");
  return gaps;
}

}  // namespace

GapParts PartsOf(const EpisodeRecord& episode) {
  GapParts parts;
  if (!episode.IsComplete()) {
    parts.failed = 1;
    return parts;
  }
  double shortest_m = 0, length_m = 0;
  bool is_known = true;
  for (const StageRecord& stage : episode.stages) {
    shortest_m += stage.shortest_m;
    length_m += stage.length_m;
    is_known = is_known && stage.extra.walk && stage.extra.walk->reach;
  }
  if (length_m <= shortest_m) return parts;  // SPL is at most 1
  if (!is_known) {
    parts.unknown = (length_m - shortest_m) / length_m;
    return parts;
  }
  for (const StageRecord& stage : episode.stages) {
    const StageReach& reach = *stage.extra.walk->reach;
    parts.detour += (reach.walked_m - reach.reach_shortest_m) / length_m;
    parts.approach +=
        (stage.length_m - reach.walked_m - (reach.end_shortest_m - reach.reach_shortest_m)) /
        length_m;
    parts.place += (reach.end_shortest_m - stage.shortest_m) / length_m;
  }
  return parts;
}

Result<std::vector<Gaps>> AttributeGaps(const std::vector<ReportRun>& runs,
                                        const BootstrapConfig& bootstrap) {
  std::set<std::string> variants;
  for (const ReportRun& run : runs) {
    if (!variants.insert(run.variant).second) {
      return Fail(ErrorCode::kInvalid, "a second run of variant " + run.variant,
                  run.folder.string());
    }
  }
  const auto ids = CommonIds(runs);
  if (ids.empty())
    return Fail(ErrorCode::kMismatch, "the runs share no episode", runs.front().folder.string());
  std::vector<Gaps> gaps;
  for (const auto& [track, some] : ids) gaps.push_back(GapsOfTrack(track, some, runs, bootstrap));
  return gaps;
}

}  // namespace crossnav::evaluation
