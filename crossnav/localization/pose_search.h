// SPDX-License-Identifier: MIT
// Pose hypotheses of a scan in a map, by exhaustive correlative matching: every place to stand and
// every heading, scored at the scan's points. The best pose of each neighbourhood is refined by
// ascent on the field of scores. No registration library: gravity leaves 4 degrees of freedom and
// the map has voxels only, so that normals and neighbour trees would not help.
#pragma once

#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/localization/dense_map.h"
#include "crossnav/localization/hypothesis.h"
#include "crossnav/localization/local_scan.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::localization {

/// Places to stand, one in each square of `step_m` and height; sorted.
std::vector<geometry::VoxelKey> StandingPlaces(const geometry::VoxelMap& map,
                                               const planner::GroundMap& ground, double step_m);

/// The best hypotheses for a foot at `p_foot_odom`, the best score first. Cost O(places x headings
/// x points).
std::vector<Hypothesis> SearchPoses(const DenseMap& map,
                                    const std::vector<geometry::VoxelKey>& places,
                                    const LocalScan& scan, const Vector3d& p_foot_odom,
                                    const LocalizeConfig& config);

/// Moves the hypothesis to the nearest maximum of the points' mean score. `points` in odom.
void Refine(const DenseMap& map, const std::vector<Vector3f>& points, const Vector3d& p_foot_odom,
            const LocalizeConfig& config, Hypothesis& hypothesis);

/// Mean score of the points under the pose, 0 to 100. `points` in odom.
double ScorePose(const DenseMap& map, const std::vector<Vector3f>& points, const Pose& T_map_odom);

/// Points for Refine.
std::vector<Vector3f> RefinePoints(const LocalScan& scan, const Vector3d& p_foot_odom,
                                   const LocalizeConfig& config);

/// Sets agreement and verdicts. A beam agrees if it ends at a surface of the map and no surface
/// blocks it; a beam that ends in unknown space has no verdict.
void CheckBeams(const DenseMap& map, const std::vector<Beam>& beams, Hypothesis& hypothesis);

}  // namespace crossnav::localization
