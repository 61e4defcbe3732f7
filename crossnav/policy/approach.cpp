// SPDX-License-Identifier: MIT
#include "crossnav/policy/approach.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/policy/stray_voxels.h"

namespace crossnav::policy {
namespace {

using geometry::CenterOf;

constexpr int kMostUnseen = 2;  // chosen: [voxels] of a ray through seen air; less than a wall

/// At most `count` voxels spread evenly over the sorted list.
std::vector<VoxelKey> Sample(const std::vector<VoxelKey>& voxels, std::size_t count) {
  if (voxels.size() <= count) return voxels;
  std::vector<VoxelKey> sample;
  for (std::size_t i = 0; i < count; ++i) sample.push_back(voxels[i * voxels.size() / count]);
  return sample;
}

/// Share of the object's voxels within reach of the depth image that are neither outside the image
/// nor hidden behind something nearer.
double FrameVisibility(const std::vector<VoxelKey>& object, const Observation& obs,
                       double voxel_m) {
  const Pose T_camera_world = obs.T_world_camera.inverse();
  int seen = 0;
  for (const VoxelKey& key : object) {
    const Vector3d p_camera = T_camera_world * CenterOf(key, voxel_m);
    if (p_camera.z() <= 0.05) continue;
    const double u = obs.camera.fx * p_camera.x() / p_camera.z() + obs.camera.cx;
    const double v = obs.camera.fy * p_camera.y() / p_camera.z() + obs.camera.cy;
    const int ui = static_cast<int>(std::lround(u)), vi = static_cast<int>(std::lround(v));
    if (!obs.depth_m.Contains(ui, vi)) continue;
    const float depth_m = obs.depth_m.At(ui, vi);
    // Its own front surface may hide a voxel by the size of a piece of furniture.
    if (depth_m > p_camera.z() - 0.6) ++seen;  // chosen: depth of a chair
  }
  return object.empty() ? 0 : static_cast<double>(seen) / static_cast<double>(object.size());
}

/// From the agent's upright axis to a voxel [m2].
double SquaredDistance(const VoxelKey& key, const Vector3d& p_world_foot, double camera_height_m,
                       double voxel_m) {
  const Vector3d d = CenterOf(key, voxel_m) - p_world_foot;
  const double dz = d.z() < 0 ? -d.z() : std::max(0.0, d.z() - camera_height_m);
  return d.x() * d.x() + d.y() * d.y() + dz * dz;
}

/// Voxels that do not count for a distance; never all of them. `object` is not empty.
std::size_t StraysOf(const std::vector<VoxelKey>& object, double stray_share) {
  return static_cast<std::size_t>(stray_share * static_cast<double>(object.size() - 1));
}

}  // namespace

ViewTest::ViewTest(const VoxelMap& map, const std::vector<VoxelKey>& object, double range_m,
                   const ApproachConfig& config, double camera_height_m)
    : map_(map),
      object_(object),
      range_m_(range_m),
      camera_height_m_(camera_height_m),
      min_visibility_(config.min_visibility),
      stray_share_(config.stray_share),
      sample_(Sample(object, 24)) {  // chosen: enough to tell a third from a half
  const double voxel_m = map.config().voxel_m;
  lo_ = hi_ = object.front();
  for (const VoxelKey& key : object) {
    lo_ = {std::min(lo_.x, key.x), std::min(lo_.y, key.y), std::min(lo_.z, key.z)};
    hi_ = {std::max(hi_.x, key.x), std::max(hi_.y, key.y), std::max(hi_.z, key.z)};
  }
  const int reach = CellsCeil(range_m, voxel_m);
  lo_ = lo_ - VoxelKey{reach, reach, CellsCeil(camera_height_m + range_m, voxel_m)};
  hi_ = hi_ + VoxelKey{reach, reach, reach};
}

/// The ray stops one and a half voxels short, since the object's own surface must not hide the
/// voxel.
bool ViewTest::IsInSight(const Vector3d& p_eye, const VoxelKey& target) const {
  const double voxel_m = map_.config().voxel_m;
  const Vector3d p_target = CenterOf(target, voxel_m);
  const double length_m = (p_target - p_eye).norm();
  if (length_m < 2 * voxel_m) return true;
  const Vector3d p_end = p_target + (p_eye - p_target) * (1.5 * voxel_m / length_m);
  return needs_seen_air_ ? map_.IsSeenThrough(p_eye, p_end, kMostUnseen)
                         : map_.HasLineOfSight(p_eye, p_end);
}

bool ViewTest::IsView(const VoxelKey& key) const {
  if (key.x < lo_.x || key.x > hi_.x || key.y < lo_.y || key.y > hi_.y || key.z < lo_.z ||
      key.z > hi_.z)
    return false;
  const double voxel_m = map_.config().voxel_m;
  Vector3d p_foot = CenterOf(key, voxel_m);
  p_foot.z() = geometry::MinCornerOf(key, voxel_m).z();
  if (!IsWithin(range_m_, object_, p_foot, camera_height_m_, voxel_m, stray_share_)) return false;
  const Vector3d p_eye = p_foot + Vector3d(0, 0, camera_height_m_);
  const auto in_sight = std::count_if(sample_.begin(), sample_.end(), [&](const VoxelKey& target) {
    return IsInSight(p_eye, target);
  });
  return static_cast<double>(in_sight) / static_cast<double>(sample_.size()) >= min_visibility_;
}

std::vector<VoxelKey> Viewpoints(const VoxelMap& map, const std::vector<VoxelKey>& object,
                                 double range_m, const ApproachConfig& config,
                                 double camera_height_m, const std::vector<Vector3d>& tried) {
  std::vector<VoxelKey> viewpoints;
  if (object.empty()) return viewpoints;
  const double voxel_m = map.config().voxel_m;
  const int reach = CellsCeil(range_m, voxel_m);
  VoxelKey lo = object.front(), hi = object.front();
  for (const VoxelKey& key : object) {
    lo = {std::min(lo.x, key.x), std::min(lo.y, key.y), std::min(lo.z, key.z)};
    hi = {std::max(hi.x, key.x), std::max(hi.y, key.y), std::max(hi.z, key.z)};
  }
  const int below = CellsCeil(camera_height_m + range_m, voxel_m);
  VoxelMap::Cursor cursor(map);
  std::vector<VoxelKey> standing;
  map.ForEachInBox(
      {lo.x - reach, lo.y - reach, lo.z - below}, {hi.x + reach, hi.y + reach, hi.z + reach},
      [&](const VoxelKey& key, const geometry::Voxel& voxel) {
        if (!FactsOf(voxel.state).is_targetable || voxel.is_inflated || IsSurface(voxel.state))
          return;
        if (IsSurface(cursor.At({key.x, key.y, key.z - 1}).state)) standing.push_back(key);
      });
  const ViewTest view(map, object, range_m, config, camera_height_m);
  for (const VoxelKey& key : standing) {
    Vector3d p_foot = CenterOf(key, voxel_m);
    p_foot.z() = geometry::MinCornerOf(key, voxel_m).z();
    const bool is_tried = std::any_of(tried.begin(), tried.end(), [&](const Vector3d& p) {
      return (p - p_foot).norm() < kSameView_m;
    });
    if (!is_tried && view.IsView(key)) viewpoints.push_back(key);
  }
  std::sort(viewpoints.begin(), viewpoints.end());
  return viewpoints;
}

double DistanceToObject(const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
                        double camera_height_m, double voxel_m, double stray_share) {
  if (object.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> squared_m2;
  for (const VoxelKey& key : object)
    squared_m2.push_back(SquaredDistance(key, p_world_foot, camera_height_m, voxel_m));
  const auto nearest =
      squared_m2.begin() + static_cast<std::ptrdiff_t>(StraysOf(object, stray_share));
  std::nth_element(squared_m2.begin(), nearest, squared_m2.end());
  return std::sqrt(*nearest);
}

bool IsWithin(double range_m, const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
              double camera_height_m, double voxel_m, double stray_share) {
  std::size_t near = 0;
  for (const VoxelKey& key : object)
    if (SquaredDistance(key, p_world_foot, camera_height_m, voxel_m) <= range_m * range_m &&
        ++near > StraysOf(object, stray_share))
      return true;
  return false;
}

Vector3d AimPoint(const std::vector<VoxelKey>& object, const Vector3d& p_world_foot,
                  double voxel_m) {
  // Long objects (beds, sofas) are aimed at where they are near, not at their far middle.
  double nearest = std::numeric_limits<double>::infinity();
  for (const VoxelKey& key : object) {
    const Vector3d d = CenterOf(key, voxel_m) - p_world_foot;
    nearest = std::min(nearest, std::hypot(d.x(), d.y()));
  }
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const VoxelKey& key : object) {
    const Vector3d p = CenterOf(key, voxel_m);
    if (std::hypot(p.x() - p_world_foot.x(), p.y() - p_world_foot.y()) > nearest + 1.0)
      continue;  // chosen
    sum += p;
    ++count;
  }
  return sum / std::max(1, count);
}

std::optional<Action> CenteringAction(const AgentPose& agent, const Vector3d& p_world,
                                      double camera_height_m, const ActionConfig& action) {
  const Vector3d d = p_world - agent.p_world - Vector3d(0, 0, camera_height_m);
  const double horizontal = std::hypot(d.x(), d.y());
  const double half_turn = DegToRad(action.turn_deg) / 2,
               half_pitch = DegToRad(action.pitch_deg) / 2;
  if (horizontal > 0.05) {
    const double yaw_error = WrapAngle(std::atan2(d.y(), d.x()) - agent.yaw_rad);
    if (std::abs(yaw_error) > half_turn + 1e-6)
      return yaw_error > 0 ? Action::kTurnLeft : Action::kTurnRight;
  }
  if (action.max_pitch_deg == 0) return std::nullopt;  // the camera is fixed
  const double pitch_error = std::atan2(d.z(), horizontal) - agent.pitch_rad;
  const double limit = DegToRad(action.max_pitch_deg) - 1e-6;
  if (pitch_error > half_pitch + 1e-6 && agent.pitch_rad < limit) return Action::kLookUp;
  if (pitch_error < -half_pitch - 1e-6 && agent.pitch_rad > -limit) return Action::kLookDown;
  return std::nullopt;
}

Verification Verify(const LivePoi& poi, const std::vector<Sighting>& sightings,
                    const Viewer& viewer, const PolicyConfig& config, double voxel_m) {
  const Observation& obs = viewer.obs;
  const Vector3d& p_foot_world = viewer.agent.p_world;
  Verification result;
  const Sighting* best = nullptr;
  for (const Sighting& sighting : sightings) {
    if (!IsSameObject(poi.voxels, poi.p_center_world, sighting.voxels, sighting.p_center_world,
                      config.object.merge_distance_m))
      continue;
    if (!best || sighting.confidence > best->confidence) best = &sighting;
  }
  result.distance_m =
      DistanceToObject(best ? WithoutStrays(poi.voxels, *best, obs, voxel_m) : poi.voxels,
                       p_foot_world, viewer.camera_height_m, voxel_m, config.approach.stray_share);
  if (!best) {
    result.failed_check = "not detected";
    return result;
  }
  const Vector3d to_object =
      AimPoint(best->voxels, p_foot_world, voxel_m) - obs.T_world_camera.translation();
  const Vector3d forward = obs.T_world_camera.linear().col(2);
  result.confidence = best->confidence;
  result.mask_quality = best->mask_quality;
  result.visibility = FrameVisibility(best->voxels, obs, voxel_m);
  result.view_angle_rad = std::acos(std::clamp(to_object.normalized().dot(forward), -1.0, 1.0));
  if (result.confidence < config.object.found_confidence)
    result.failed_check = "confidence";
  else if (result.mask_quality < config.approach.min_mask_quality)
    result.failed_check = "mask quality";
  else if (result.visibility < config.approach.min_visibility)
    result.failed_check = "visibility";
  else if (result.view_angle_rad > DegToRad(config.approach.max_view_angle_deg))
    result.failed_check = "viewing direction";
  else if (result.distance_m > config.approach.range_m)
    result.failed_check = "distance";
  result.passed = result.failed_check.empty();
  return result;
}

}  // namespace crossnav::policy
