// SPDX-License-Identifier: MIT
// Figures of visits by track, with intervals, and paired comparisons of runs. The bootstrap draws
// whole houses, because visits of a house are correlated. Pure and seeded.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// A mean with its percentile interval, 95 %.
struct Figure {
  double value = 0;
  Interval interval;
};

struct TrackFigures {
  int visits = 0, goals = 0;
  Figure success;             ///< Wilson's interval
  std::optional<Figure> spl;  ///< from the previous stop; without absent goals
  Figure unspent;             ///< remaining share of the budget
  double stale_visits = 0;    ///< mean per goal
  int revised = 0;            ///< goals with a visit to a stale place
  double revised_after = 0;   ///< actions, mean over the revised goals
};

/// By track, in the order of kVisitTracks; tracks without goals are left out.
std::vector<std::pair<std::string, TrackFigures>> FiguresOf(const VisitResults& results,
                                                            const BootstrapConfig& bootstrap = {});

/// Differences b - a on goals played in both runs.
struct TrackDifference {
  int goals = 0, houses = 0;
  Figure success;
  std::optional<Figure> spl;
};
struct VisitComparison {
  std::string name_a, name_b;
  std::vector<std::pair<std::string, TrackDifference>> tracks;
  bool is_forced = false;  ///< settings, perception or version differ
};

/// Error: runs of other visits; unless `is_forced`, also of other settings, perception or version.
Result<VisitComparison> CompareVisits(const VisitResults& a, const VisitResults& b,
                                      const BootstrapConfig& bootstrap = {},
                                      bool is_forced = false);

std::string VisitReportMarkdown(const std::string& suite, const std::vector<VisitResults>& runs,
                                const std::vector<VisitComparison>& comparisons);
std::string VisitReportJson(const std::vector<VisitResults>& runs,
                            const std::vector<VisitComparison>& comparisons);

}  // namespace crossnav::evaluation
