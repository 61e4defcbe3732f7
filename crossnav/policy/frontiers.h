// SPDX-License-Identifier: MIT
// Basic Frontiers (paper, "Candidate Navigation Points"; supplement, sec:supp_navigation_modes):
// where supported space meets the unknown, and where it meets a drop. Pure functions of the map.
#pragma once

#include <vector>

#include "crossnav/planner/astar.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Supports within `level_band_m` of the exploration level.
planner::LevelBand BandAround(double level_m, const FrontierConfig& config, double voxel_m);

/// Boundaries of TRAVERSABLE with genuine unknown space on this level, one candidate per cluster.
/// `min_cluster` is the configured value, or the smaller value of the first steps.
std::vector<Candidate> TraversableFrontiers(const VoxelMap& map, const planner::LevelBand& level,
                                            const FrontierConfig& config, int min_cluster);

/// Edges of the level without support beyond: the ground below is unseen or lower than the support
/// depth under the level.
std::vector<Candidate> DescendFrontiers(const VoxelMap& map, const planner::LevelBand& level,
                                        const FrontierConfig& config);

}  // namespace crossnav::policy
