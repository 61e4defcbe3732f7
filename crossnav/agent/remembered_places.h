// SPDX-License-Identifier: MIT
// History POIs for the goal's text, from the current memory (paper, "Query-Conditioned Retrieval").
#pragma once

#include <optional>
#include <vector>

#include "crossnav/agent/state.h"

namespace crossnav::agent {

/// Best first; empty where the variant has no history POIs.
std::vector<HistoryPoi> RememberedPlaces(const World& world, const GoalState& goal,
                                         const Config& config);

/// Similarity of the memory at `voxels` to the goal's text: mean cosine of the best quarter of its
/// rows there, or nothing without rows. Found objects calibrate by it how strongly the encoder
/// answers to the real object.
std::optional<double> SimilarityAt(const World& world, const GoalState& goal,
                                   const std::vector<geometry::VoxelKey>& voxels);

}  // namespace crossnav::agent
