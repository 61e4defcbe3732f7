// SPDX-License-Identifier: MIT
// Query-conditioned retrieval (paper, "Query-Conditioned 3D Retrieval"): the voxels whose similarity
// stands out, clustered in 3D, best four first. Pure functions of the memory.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::memory {

struct QueryConfig {
  int top_k = 4;                      ///< tab:supp_configuration, "Retrieved clusters"
  std::string relevancy = "cosine";   ///< cosine | contrastive
  double min_similarity = 0.2;        // chosen: tuned on the generated development houses
  double min_z_score = 3.0;           // chosen: robust z against the whole field
  int min_voxels = 5;                 // chosen: as the frontier's minimum cluster
  double cluster_radius_vox = 2.0;    // chosen: bridges one missing voxel
};

template <class V>
void Visit(V& visit, QueryConfig& c) {
  visit("top_k", c.top_k, 1, 1000);
  visit("relevancy", c.relevancy, {"cosine", "contrastive"});
  visit("min_similarity", c.min_similarity, -1.0, 1.0);
  visit("min_z_score", c.min_z_score, 0.0, 100.0);
  visit("min_voxels", c.min_voxels, 1, 100000);
  visit("cluster_radius_vox", c.cluster_radius_vox, 1.0, 20.0);
}

/// One place in the memory that answers a query.
struct MemoryCluster {
  std::vector<std::int64_t> rows;  ///< supporting rows, ascending
  std::vector<VoxelKey> voxels;    ///< their keys, sorted
  Vector3d p_center_world = Vector3d::Zero();  ///< weighted centre [m]
  Box3 box;                                    ///< [m]
  double score = 0;
  Vector3d p_best_view_world = Vector3d::Zero();  ///< camera position it was best seen from [m]
};

/// Best `top_k` clusters for `text`, best first. Empty memory or nothing that stands out: empty.
/// `background` holds text vectors for the contrastive relevancy; unused by cosine.
std::vector<MemoryCluster> Query(const SemanticMemory& memory, std::span<const float> text,
                                 const QueryConfig& config,
                                 std::span<const std::vector<float>> background = {});

}  // namespace crossnav::memory
