// SPDX-License-Identifier: MIT
// Comparison of two runs on the same episodes: whether it is fair, the differences of their
// figures, and the episodes with different endings. Pure functions; the intervals are seeded.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// Differences between two headers. Each line names a key and both values.
struct HeaderComparison {
  std::vector<std::string> unfair;    ///< settings that the runs must share
  std::vector<std::string> compared;  ///< settings of the agent: the subject of the comparison
};

/// Unfair: other episodes, scenes, seed, program version or perception, and settings that change
/// the task (sections sensor, action, navmesh, ground_truth, eval, dataset), except
/// eval.episode_seconds. All other settings are compared.
HeaderComparison CompareHeaders(const RunHeader& a, const RunHeader& b);

/// Ending of an episode in a run.
struct Ending {
  std::string outcome;           ///< EpisodeRecord::OutcomeName
  int goals = 0;                 ///< completed goals
  std::string cause;             ///< CauseOf the failed stage, or the reason for a missing result
  std::filesystem::path replay;  ///< replay kept by the run; empty = none
};

/// An episode completed in only one of the runs.
struct Flip {
  std::string episode_id;
  int goals = 0;
  Ending before, after;
};

struct Comparison {
  std::string name_a, name_b;
  int episodes = 0, scenes = 0;                         ///< common to both runs
  std::map<std::string, PairedDifference> differences;  ///< by NamedStatistics, b - a
  std::vector<std::string> order;                       ///< names of the differences, as reported
  std::vector<Flip> flips;                              ///< by episode id
  HeaderComparison headers;
};

/// Compares the common episodes. Unless `is_forced`, fails with the first difference that makes the
/// comparison unfair, or if a header is missing.
Result<Comparison> CompareRuns(const ReportRun& a, const ReportRun& b,
                               const BootstrapConfig& bootstrap, bool is_forced);

/// Links to replays are relative to `folder`, the place of the text.
std::string ComparisonMarkdown(const Comparison& comparison, const std::filesystem::path& folder);
std::string ComparisonText(const Comparison& comparison);  ///< for a terminal
std::string ComparisonsJson(const std::vector<Comparison>& comparisons);

}  // namespace crossnav::evaluation
