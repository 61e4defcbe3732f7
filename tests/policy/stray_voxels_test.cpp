// SPDX-License-Identifier: MIT
#include "crossnav/policy/stray_voxels.h"

#include <gtest/gtest.h>

#include "crossnav/core/camera.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/live_poi.h"

namespace crossnav::policy::strays {
namespace {

constexpr int kSide_px = 320;
constexpr double kVoxel_m = 0.1, kCamera_m = 0.88;
constexpr double kFront_m = 5.0;  // x of the front of the box that is the object

/// View of a floor and of a box on it, 2 m wide and 0.8 m high. The camera is level above (x, 0)
/// and looks along +x.
Observation ViewFrom(double x_m) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(kSide_px, kSide_px, DegToRad(90));
  obs.rgb = RgbImage(kSide_px, kSide_px);
  obs.depth_m = DepthImage(kSide_px, kSide_px, 0.0F);
  obs.T_world_camera = CameraPose({Vector3d(x_m, 0, 0), 0, 0}, kCamera_m);
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 0; u < kSide_px; ++u) {
      const double right = (u - obs.camera.cx) / obs.camera.fx;
      const double down = (v - obs.camera.cy) / obs.camera.fy;
      const double front_m = kFront_m - x_m, floor_m = down > 0 ? kCamera_m / down : 9;
      const bool is_box = std::abs(right * front_m) < 1 && down * front_m > 0.08;
      obs.depth_m.At(u, v) = static_cast<float>(std::min(is_box ? front_m : 9, floor_m));
    }
  return obs;
}

/// The box, with a mask that ends `beyond_m` before it on the floor.
perception::Detection Masked(const Observation& obs, double beyond_m) {
  perception::Detection detection;
  detection.box = {0, 0, kSide_px, kSide_px};
  detection.confidence = detection.mask_quality = 0.9F;
  detection.mask = MaskImage(kSide_px, kSide_px, 0);
  const double front_m = kFront_m - obs.T_world_camera.translation().x();
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 0; u < kSide_px; ++u) {
      const double depth_m = obs.depth_m.At(u, v);
      const double right_m = depth_m * (u - obs.camera.cx) / obs.camera.fx;
      if (depth_m < 8 && depth_m >= front_m - beyond_m && std::abs(right_m) < 1)
        detection.mask.At(u, v) = 1;
    }
  return detection;
}

class Strays : public ::testing::Test {
 protected:
  /// A frame from `x_m` with a mask that reaches `beyond_m` over the floor.
  void Look(double x_m, double beyond_m) {
    const Observation obs = ViewFrom(x_m);
    const auto sightings = LiftDetections({Masked(obs, beyond_m)}, obs, {}, kObject, 0.6);
    ASSERT_EQ(sightings.size(), 1U);
    pois_.Update(sightings, kObject, kVoxel_m, step_++);
    pois_.DropStrays(sightings, obs, kObject, kVoxel_m);
  }
  /// From a foot at `x_m` to the object as it is known.
  double DistanceFrom(double x_m) const {
    return DistanceToObject(pois_.all().front().voxels, {x_m, 0, 0}, kCamera_m, kVoxel_m, 0);
  }
  const ObjectConfig kObject;
  LivePois pois_;
  int step_ = 0;
};

TEST_F(Strays, MasksFromAfarThatReachOverTheFloorDoNotShortenTheDistance) {
  for (int i = 0; i < 5; ++i) Look(1.5, 0.7);
  EXPECT_LT(DistanceFrom(3.0), 1.45);  // as near as the masks said
  Look(3.0, 0);
  EXPECT_NEAR(DistanceFrom(3.0), 2.0, 0.15);
}

TEST_F(Strays, OneBadMaskAmongGoodOnesFromTheSamePlaceIsOutvoted) {
  Look(3.0, 0);
  Look(3.0, 0.7);
  EXPECT_LT(DistanceFrom(3.0), 1.5);
  for (int i = 0; i < 2; ++i) Look(3.0, 0);
  EXPECT_NEAR(DistanceFrom(3.0), 2.0, 0.15);
}

TEST_F(Strays, ExactMasksLoseNothing) {
  std::vector<VoxelKey> seen;
  for (const double x_m : {0.5, 1.5, 2.5, 3.5}) {
    Look(x_m, 0);
    const auto& voxels = pois_.all().front().voxels;
    EXPECT_TRUE(std::includes(voxels.begin(), voxels.end(), seen.begin(), seen.end())) << x_m;
    seen = voxels;
  }
}

TEST_F(Strays, AMaskThatOnceMissesAPartOfTheObjectLosesNothingSeenFromNearer) {
  for (int i = 0; i < 3; ++i) Look(3.5, 0);
  const auto whole = pois_.all().front().voxels;
  Observation obs = ViewFrom(1.0);
  perception::Detection half = Masked(obs, 0);
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 0; u < kSide_px / 2; ++u) half.mask.At(u, v) = 0;
  const auto sightings = LiftDetections({half}, obs, {}, kObject, 0.6);
  pois_.Update(sightings, kObject, kVoxel_m, step_++);
  pois_.DropStrays(sightings, obs, kObject, kVoxel_m);
  const auto& voxels = pois_.all().front().voxels;
  EXPECT_TRUE(std::includes(voxels.begin(), voxels.end(), whole.begin(), whole.end()));
}

TEST(VoteOnVoxels, SomethingAlwaysRemains) {
  const Observation obs = ViewFrom(3.0);
  std::vector<VoxelKey> floor = {{41, 0, 0}, {42, 0, 0}};
  VoxelVotes votes(2, 0.0F);
  Sighting elsewhere;
  elsewhere.voxels = {{50, 0, 3}};
  VoteOnVoxels(elsewhere, obs, kVoxel_m, &floor, &votes);
  EXPECT_EQ(floor.size(), 2U);
}

}  // namespace
}  // namespace crossnav::policy::strays
