// SPDX-License-Identifier: MIT
// Goals of OneMap: frontiers and points of interest in one list, ranked by the map's similarity to
// the goal, and the check of detections. Pure functions.
#pragma once

#include <vector>

#include "crossnav/policy/onemap_map.h"

namespace crossnav::policy {

struct OneMapGoal {
  bool is_frontier = true;      ///< or a point of interest
  Column center;                ///< the frontier's middle, the cluster's peak
  std::vector<Column> columns;  ///< sorted
  double score = 0;             ///< largest cosine + 1 behind the frontier, in the cluster
};

/// Inputs of the functions below.
struct OneMapView {
  const OneMapMap& map;
  const StandingColumns& standing;
  const SimilarityField& similarity;
  const OneMapConfig& config;
  double voxel_m = 0.1;
};

/// Best first; ties by column.
std::vector<OneMapGoal> OneMapGoals(const OneMapView& view);

/// The next goal: the last goal while it exists and its score holds, else the best. Index, or -1
/// without goals.
int ChooseOneMapGoal(const std::vector<OneMapGoal>& goals, const OneMapGoal* last,
                     const OneMapView& view);

/// Whether the column lies among, or near, the columns that answer the goal best ("consensus").
bool HasConsensus(const Column& column, const OneMapView& view);

/// Distance of two columns' centres [m].
double DistanceOf(const Column& a, const Column& b, double voxel_m);

}  // namespace crossnav::policy
