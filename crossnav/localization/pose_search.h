// SPDX-License-Identifier: MIT
// Hypotheses for the pose of a scan in a map: every place to stand of the map, every heading,
// scored by where the scan's points fall (a correlative match over a grid, every pose of it), the
// best of each neighbourhood refined. The 4 degrees of freedom that gravity leaves, and voxels as
// the map's only points, make a registration library's normals and neighbour trees idle: the
// refinement is a descent on the field that the search needs anyhow.
#pragma once

#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/localization/dense_map.h"
#include "crossnav/localization/hypothesis.h"
#include "crossnav/localization/local_scan.h"
#include "crossnav/planner/ground_map.h"

namespace crossnav::localization {

/// Places of the map where a foot can be, about one in each square of `step_m` and height; sorted.
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

/// Fills in agreement and verdicts: a beam agrees that ends at a surface of the map with nothing in
/// its way; it says nothing where the map is unknown.
void CheckBeams(const DenseMap& map, const std::vector<Beam>& beams, Hypothesis& hypothesis);

}  // namespace crossnav::localization
