// SPDX-License-Identifier: MIT
// A landing whose surface is the bottom face of its voxels (map.clearing = evidence).
#include "crossnav/geometry/tread_sight.h"

#include <gtest/gtest.h>

#include "crossnav/geometry/voxel_map.h"

namespace crossnav::geometry {
namespace {

constexpr double kLanding_m = 1.7001;
constexpr int kSide_px = 160;

const CameraIntrinsics& Camera() {
  static const CameraIntrinsics camera = IntrinsicsFromHfov(kSide_px, kSide_px, M_PI / 2);
  return camera;
}

/// A frame from `p_world` in which every ray goes on for `depth_m`.
void Look(VoxelMap& map, const Vector3d& p_world, const Vector3d& ahead, double depth_m) {
  Pose T_world_camera = Pose::Identity();
  const Vector3d right = Vector3d(0, -1, 0);
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = ahead.cross(right);
  T_world_camera.linear().col(2) = ahead;
  T_world_camera.translation() = p_world;
  const DepthImage depth_m_of(kSide_px, kSide_px, static_cast<float>(depth_m));
  map.Integrate(depth_m_of, Camera(), T_world_camera);
  map.UpdateStates();
}

/// Voxels of the landing that are left, of those in the middle of the camera's view.
int LandingAfter(bool is_stair, const Vector3d& p_world, const Vector3d& ahead) {
  MapConfig config;
  config.clearing = "evidence";
  VoxelMap map(config);
  for (int i = 0; i < 5; ++i) Look(map, {4.5, 0, kLanding_m + 1.5}, -Vector3d::UnitZ(), 1.5);
  std::vector<VoxelKey> keys;
  for (int x = 42; x < 48; ++x)
    for (int y = -3; y < 3; ++y) keys.push_back({x, y, 17});
  if (is_stair) map.MarkStair(keys, StairMark::kStair);
  map.UpdateStates();
  for (const VoxelKey& key : keys) EXPECT_TRUE(IsSurface(map.At(key).state));
  for (int i = 0; i < 40; ++i) Look(map, p_world, ahead, 6);
  int left = 0;
  for (const VoxelKey& key : keys) left += IsSurface(map.At(key).state) ? 1 : 0;
  return left;
}

// Regression: from the floor below, rays passed above a landing through its voxels, and the agent
// on the floor above searched 800 actions for a way down.
TEST(TreadSight, ALandingSeenFromBelowIsKept) {
  const Vector3d p_below(0.5, 0, 1.1), ahead = Vector3d::UnitX();
  EXPECT_EQ(LandingAfter(true, p_below, ahead), 36);
  EXPECT_EQ(LandingAfter(false, p_below, ahead), 0) << "other surfaces are seen through";
}

TEST(TreadSight, ALandingThatIsGoneIsClearedFromAbove) {
  const Vector3d p_above(4.5, 0, 3.2);
  EXPECT_EQ(LandingAfter(true, p_above, -Vector3d::UnitZ()), 0);
}

}  // namespace
}  // namespace crossnav::geometry
