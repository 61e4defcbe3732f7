// SPDX-License-Identifier: MIT
// Query-conditioned retrieval (paper, "Query-Conditioned 3D Retrieval"): voxels with outstanding
// similarity, clustered in 3D, best four first. Pure functions of the memory. Outstanding: a robust
// z-score against the whole field (median and MAD), an absolute floor on the cosine, and a share of
// the field's own peak, so that look-alikes do not crowd out the object. Score of a cluster: mean
// excess of its best quarter over the field's median, in robust deviations, times log2(1 + voxels).
// The best quarter tolerates blurred borders; the logarithm prefers bodies to stray voxels without
// letting a large look-alike beat a small object.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/setting.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::memory {

struct QueryConfig {
  int top_k = 4;                     ///< tab:supp_configuration, "Retrieved clusters"
  std::string relevancy = "cosine";  ///< cosine | contrastive
  double min_similarity = 0.2;       // chosen: tuned on the generated development houses
  double min_z_score = 3.0;          // chosen: robust z against the whole field
  double min_peak_share = 0.5;       // chosen: of the peak's excess over the median; 0 = off
  double contrast = 10.0;            // chosen: inverse temperature of the contrastive relevancy
  int min_voxels = 5;                // chosen: as the frontier's minimum cluster
  double cluster_radius_vox = 2.0;   // chosen: bridges one missing voxel
};

template <class V>
void Visit(V& visit, QueryConfig& c) {
  visit(CROSSNAV_SETTING(c, top_k), 1, 1000);
  visit(CROSSNAV_SETTING(c, relevancy), {"cosine", "contrastive"});
  visit(CROSSNAV_SETTING(c, min_similarity), -1.0, 1.0);
  visit(CROSSNAV_SETTING(c, min_z_score), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, min_peak_share), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, contrast), 0.1, 1000.0);
  visit(CROSSNAV_SETTING(c, min_voxels), 1, 100000);
  visit(CROSSNAV_SETTING(c, cluster_radius_vox), 1.0, 20.0);
}

/// Background prompts that compete with a goal in the contrastive relevancy.
inline constexpr std::array<const char*, 5> kBackgroundPrompts = {"wall", "floor", "ceiling",
                                                                  "furniture", "thing"};  // chosen

/// One place in the memory that answers a query.
struct MemoryCluster {
  std::vector<std::int64_t> rows;              ///< supporting rows, ascending
  std::vector<VoxelKey> voxels;                ///< their keys, sorted
  Vector3d p_center_world = Vector3d::Zero();  ///< centre, weighted by excess similarity [m]
  Box3 box;                                    ///< [m]
  double score = 0;       ///< see the head of this file; comparable within one query only
  double similarity = 0;  ///< mean cosine of the best quarter [-1, 1]
  Vector3d p_best_view_world = Vector3d::Zero();  ///< camera position of the best view [m]
  double best_view_yaw_rad = 0;                   ///< from there to the centre
  double best_view_pitch_rad = 0;                 ///< likewise; positive looks up
};

/// Field used for ranking, in row order: cosine, or with `relevancy = contrastive` and at least one
/// background vector min_b softmax(contrast * (cos text, cos b)) in [0, 1].
std::vector<float> RelevancyField(const SemanticMemory& memory, std::span<const float> text,
                                  const QueryConfig& config,
                                  std::span<const std::vector<float>> background = {});

/// Best `top_k` clusters for `text`, best first. Empty if the memory is empty or no voxel stands
/// out. `background` holds text vectors for the contrastive relevancy; unused by cosine.
std::vector<MemoryCluster> Query(const SemanticMemory& memory, std::span<const float> text,
                                 const QueryConfig& config,
                                 std::span<const std::vector<float>> background = {});

}  // namespace crossnav::memory
