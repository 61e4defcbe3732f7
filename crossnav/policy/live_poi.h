// SPDX-License-Identifier: MIT
// Live POIs (paper, "Candidate Navigation Points"): detections of the current goal lifted to 3D and
// merged across frames. A POI is stable once enough frames agree.
#pragma once

#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/observation.h"
#include "crossnav/perception/perception.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/policy_config.h"
#include "crossnav/policy/stray_voxels.h"

namespace crossnav::policy {

/// One detection in 3D.
struct Sighting {
  std::vector<VoxelKey> voxels;       ///< largest connected part, sorted
  std::vector<VoxelKey> other_parts;  ///< all others, sorted
  Vector3d p_center_world = Vector3d::Zero();
  double confidence = 0;
  double mask_quality = 0;
  double area_fraction = 0;  ///< of the box in the image
  bool is_framed = false;    ///< neither side of the image cuts the box
  int detection = -1;        ///< index of the detection it was lifted from; -1 = not known
};

struct LivePoi {
  int id = 0;
  std::vector<VoxelKey> voxels;  ///< everything seen of it but for strays, sorted
  VoxelVotes votes;              ///< of the voxels; see LivePois::DropStrays
  Vector3d p_center_world = Vector3d::Zero();
  int frames = 0;         ///< agreeing frames
  double confidence = 0;  ///< best so far
  int last_seen_step = 0;
  bool is_discarded = false;  ///< verification failed from every viewpoint
};

/// Detections of at least `min_confidence` with enough voxels, lifted through depth and pose.
std::vector<Sighting> LiftDetections(const std::vector<perception::Detection>& detections,
                                     const Observation& obs, const geometry::MapConfig& map_config,
                                     const ObjectConfig& config, double min_confidence);

/// The POIs of one goal.
class LivePois {
 public:
  /// Merges sightings that are confident and large enough (tab:supp_configuration, "Object"). The
  /// POI `approached` (-1 = none) also takes sightings of the secondary confidence.
  void Update(const std::vector<Sighting>& sightings, const ObjectConfig& config, double voxel_m,
              int step, int approached = -1);

  /// Takes from each POI in sight the voxels that nearer frames than those of their masks show
  /// beside the object. After Update, with the same sightings and the frame that they are of.
  void DropStrays(const std::vector<Sighting>& sightings, const Observation& obs,
                  const ObjectConfig& config, double voxel_m);

  /// Stable and not discarded, most confident first.
  std::vector<const LivePoi*> Stable(const ObjectConfig& config) const;

  /// Adds a POI of another list as a stable one; returns its id here.
  int Adopt(const LivePoi& poi, const ObjectConfig& config);

  const LivePoi* Find(int id) const;
  void Discard(int id);
  const std::vector<LivePoi>& all() const { return pois_; }
  void Forgive(int id);
  void ForgiveDiscarded();

 private:
  std::vector<LivePoi> pois_;
  int next_id_ = 1;
};

/// True if the centres are close, or a fifth of the smaller object's voxels belong to both.
bool IsSameObject(const std::vector<VoxelKey>& a, const Vector3d& a_center,
                  const std::vector<VoxelKey>& b, const Vector3d& b_center,
                  double merge_distance_m);

}  // namespace crossnav::policy
