// SPDX-License-Identifier: MIT
// Attribution of 1 - SPL, from the records of runs of the variants full, known-map and
// known-objects on the same episodes (docs/navigation.md, "What a shorter path would need"). Pure
// functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// Shares of 1 - SPL, mean over episodes; their sum is 1 - SPL. A completed episode of length L and
/// shortest path D loses (L - D) / L, a failed one 1.
struct GapParts {
  double failed = 0;
  double detour = 0;    ///< before the goal was within the success radius: search and detours
  double approach = 0;  ///< from there to STOP
  double place = 0;     ///< STOP at another instance or place than the nearest viewpoint
  double unknown = 0;   ///< of records without the parts (older versions, slivers)
  double Sum() const { return failed + detour + approach + place + unknown; }
};

/// Mean over executed stages.
struct StageMeans {
  int stages = 0;
  double forward = 0, turn = 0, look = 0;  ///< actions
  double shortest_m = 0, length_m = 0;     ///< of successful stages
};

struct RunGaps {
  std::string name, variant;
  double sr = 0, spl = 0;
  GapParts parts;
  StageMeans means;
};

/// One origin of buildings, on the episodes common to all runs.
struct Gaps {
  std::string track;  ///< empty if records name none
  int episodes = 0;
  std::vector<RunGaps> runs;                 ///< in the order given
  std::optional<PairedDifference> geometry;  ///< SPL of known-map less full: price of unknown rooms
  std::optional<PairedDifference> search;  ///< known-objects less known-map: price of search order
};

/// The parts of 1 - SPL of one episode.
GapParts PartsOf(const EpisodeRecord& episode);

/// One entry per track. Errors: no common episode, two runs of one variant.
Result<std::vector<Gaps>> AttributeGaps(const std::vector<ReportRun>& runs,
                                        const BootstrapConfig& bootstrap);

std::string GapsText(const std::vector<Gaps>& gaps);
std::string GapsJson(const std::vector<Gaps>& gaps);

}  // namespace crossnav::evaluation
