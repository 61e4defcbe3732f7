// SPDX-License-Identifier: MIT
// Final approach and verification (paper, "Final Target-Object Approach and Verification"): where
// to stand, how to look, and whether the current frame proves the object. The evaluator's success
// radius is not known here.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/camera.h"
#include "crossnav/core/observation.h"
#include "crossnav/policy/candidates.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

constexpr double kSameView_m = 0.4;  // chosen: places closer than this have the same view

/// Tells from where enough of an object can be seen, near enough. Keeps references.
class ViewTest {
 public:
  ViewTest(const VoxelMap& map, const std::vector<VoxelKey>& object, double range_m,
           const ApproachConfig& config, double camera_height_m);
  /// From now on unobserved space may hide the object: a wall whose surface was never seen.
  void AskForSeenAir() { needs_seen_air_ = true; }
  /// Standing at `key`: the object is within range and in free line of sight.
  bool IsView(const VoxelKey& key) const;
  /// Views lie within this box, both corners included.
  const VoxelKey& lo() const { return lo_; }
  const VoxelKey& hi() const { return hi_; }

 private:
  bool IsInSight(const Vector3d& p_eye, const VoxelKey& target) const;

  const VoxelMap& map_;
  const std::vector<VoxelKey>& object_;
  double range_m_, camera_height_m_, min_visibility_, stray_share_;
  bool needs_seen_air_ = false;
  std::vector<VoxelKey> sample_;
  VoxelKey lo_, hi_;  // box of the object, grown by the range
};

/// Standing voxels within `range_m` of the object with enough of it in free line of sight from
/// camera height. Sorted by key; may be empty. `tried` places are left out.
std::vector<VoxelKey> Viewpoints(const VoxelMap& map, const std::vector<VoxelKey>& object,
                                 double range_m, const ApproachConfig& config,
                                 double camera_height_m, const std::vector<Vector3d>& tried = {});

/// Distance from the agent's upright axis (foot to camera) to the object [m]: to its nearest voxel,
/// after the share `stray_share` of voxels that are nearer. Infinite for an empty object.
double DistanceToObject(const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
                        double camera_height_m, double voxel_m, double stray_share);
/// Whether that distance is at most `range_m`; faster.
bool IsWithin(double range_m, const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
              double camera_height_m, double voxel_m, double stray_share);

/// Where to point the camera: the centre of the object's voxels that lie near the agent.
Vector3d AimPoint(const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
                  double voxel_m);

/// Turn or pitch step that brings `p_world` nearer to the image centre; nullopt when no step helps.
std::optional<Action> CenteringAction(const AgentPose& agent, const Vector3d& p_world,
                                      double camera_height_m, const ActionConfig& action);

struct Verification {
  bool passed = false;
  std::string failed_check;  ///< the first that did not pass
  double confidence = 0, mask_quality = 0, visibility = 0, view_angle_rad = 0, distance_m = 0;
};

/// The current frame, and the robot that looks.
struct Viewer {
  const Observation& obs;
  AgentPose agent;
  double camera_height_m = 0;  ///< above the foot
};

/// Checks the current frame: detection confidence, mask quality, visibility, viewing direction and
/// 3D distance must all pass. The distance leaves out voxels that the frame shows beside the
/// object's mask, and the nearest `stray_share` of the others.
Verification Verify(const LivePoi& poi, const std::vector<Sighting>& sightings,
                    const Viewer& viewer, const PolicyConfig& config, double voxel_m);

}  // namespace crossnav::policy
