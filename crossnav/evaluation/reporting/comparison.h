// SPDX-License-Identifier: MIT
// Two runs on the same episodes: whether they may be compared at all, by how much their figures
// differ, and which episodes ended differently. Pure functions; the intervals are seeded.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// How two headers differ. Each line names a key and both values.
struct HeaderComparison {
  std::vector<std::string> unfair;    ///< what the runs would have to share
  std::vector<std::string> compared;  ///< settings of the agent: what a comparison is about
};

/// Unfair are other episodes, scenes, seed, program version or perception, and settings that make
/// the task another one (sections sensor, action, navmesh, ground_truth, eval, dataset), except
/// eval.episode_seconds. All others are what is compared.
HeaderComparison CompareHeaders(const RunHeader& a, const RunHeader& b);

/// How an episode ended in a run.
struct Ending {
  std::string outcome;           ///< EpisodeRecord::OutcomeName
  int goals = 0;                 ///< completed ones
  std::string cause;             ///< CauseOf the stage that failed, or why there is no result
  std::filesystem::path replay;  ///< that the run kept of it; empty = none
};

/// An episode that was completed in one of the runs only.
struct Flip {
  std::string episode_id;
  int goals = 0;
  Ending before, after;
};

struct Comparison {
  std::string name_a, name_b;
  int episodes = 0, scenes = 0;                         ///< that both runs have
  std::map<std::string, PairedDifference> differences;  ///< by NamedStatistics, b - a
  std::vector<std::string> order;                       ///< names of the differences, as reported
  std::vector<Flip> flips;                              ///< by episode id
  HeaderComparison headers;
};

/// Compares the episodes that both have. Fails with the first difference that makes it unfair, or
/// where nothing says that they share a header, unless `is_forced`.
Result<Comparison> CompareRuns(const ReportRun& a, const ReportRun& b,
                               const BootstrapConfig& bootstrap, bool is_forced);

/// Links to replays are relative to `folder`, where the text will lie.
std::string ComparisonMarkdown(const Comparison& comparison, const std::filesystem::path& folder);
std::string ComparisonText(const Comparison& comparison);  ///< for a terminal
std::string ComparisonsJson(const std::vector<Comparison>& comparisons);

}  // namespace crossnav::evaluation
