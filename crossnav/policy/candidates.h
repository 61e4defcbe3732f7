// SPDX-License-Identifier: MIT
// Candidates of the agent (paper, eq:supp_candidate_set). A candidate is a set of places to stand
// with a focus point. World frame, metres.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::policy {

using geometry::VoxelKey;
using geometry::VoxelMap;

/// In order of priority (eq:supp_candidate_priority); stair frontiers exist only inside a session.
enum class CandidateKind {
  kLivePoi,
  kHistoryPoi,
  kTraversableFrontier,
  kDescendFrontier,
  kAscentFrontier,
  kStairFrontier,
  // Of policy.profile = full, below the frontiers of the level.
  kSighting,     ///< the goal was seen, too weakly or where it cannot be approached yet
  kUninspected,  ///< ground seen only from where the detector does not answer
  kSearchView,   ///< a view of places where the goal may stand unnoticed
  kClosedWay,    ///< a door on the way to a remembered place that was shut on an earlier day
};

std::string_view NameOf(CandidateKind kind);

/// Of policy.profile = full: a frontier of any level.
constexpr bool IsFrontier(CandidateKind kind) {
  return kind == CandidateKind::kTraversableFrontier || kind == CandidateKind::kStairFrontier;
}

struct Candidate {
  CandidateKind kind = CandidateKind::kTraversableFrontier;
  Vector3d p_focus_world = Vector3d::Zero();  ///< focus, e.g. the cluster's centre
  std::vector<VoxelKey> standing;             ///< voxels from which it counts as reached
  std::vector<VoxelKey> beyond;               ///< frontiers: cells beyond each standing voxel;
                                              ///< search views: the patches they show
  int size = 0;                               ///< [voxels]
  double score = 0;                           ///< higher is better, within its class
  std::optional<int> poi_id;                  ///< of the live POI or hint behind it
};

/// A vertical cylinder in which nothing is tried again.
struct BlacklistedPlace {
  Vector3d p_world = Vector3d::Zero();
  double radius_m = 0.8;
  double half_height_m = 0.6;
};

bool IsBlacklisted(const std::vector<BlacklistedPlace>& places, const Vector3d& p_world);

}  // namespace crossnav::policy
