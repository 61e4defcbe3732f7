// SPDX-License-Identifier: MIT
// Treads in one depth picture: flights of known riser and tread, drawn by a ray for each pixel, and
// things that are none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "crossnav/geometry/treads.h"

namespace crossnav::geometry {
namespace {

constexpr CameraIntrinsics kCamera = {320, 240, 230, 230, 159.5, 119.5};

/// At 1.2 m above the ground, ahead is +x, looking down.
Pose CameraPose(double pitch_down_deg, double yaw_deg) {
  const double pitch = DegToRad(pitch_down_deg), yaw = DegToRad(yaw_deg);
  const Vector3d ahead(std::cos(yaw), std::sin(yaw), 0), left(-std::sin(yaw), std::cos(yaw), 0);
  Eigen::Matrix3d R;
  R.col(0) = -left;
  R.col(2) = std::cos(pitch) * ahead - std::sin(pitch) * Vector3d::UnitZ();
  R.col(1) = R.col(2).cross(R.col(0));
  Pose T_world_camera = Pose::Identity();
  T_world_camera.linear() = R;
  T_world_camera.translation() = Vector3d(0, 0, 1.2);
  return T_world_camera;
}

/// Depth of a world that is solid where `is_solid`, by small steps along each ray.
DepthImage Draw(const Pose& T_world_camera, const std::function<bool(const Vector3d&)>& is_solid) {
  constexpr double kStep_m = 0.005;
  DepthImage depth_m(kCamera.width_px, kCamera.height_px, 0.0F);
  for (int v = 0; v < depth_m.height; ++v)
    for (int u = 0; u < depth_m.width; ++u)
      for (double z = 0.3; z < 6; z += kStep_m)
        if (is_solid(T_world_camera * BackProjectPixel(kCamera, u, v, z))) {
          depth_m.At(u, v) = static_cast<float>(z);
          break;
        }
  return depth_m;
}

struct Stairs {
  int treads;
  double riser_m, tread_m;
  bool operator()(const Vector3d& p) const {
    if (p.z() <= 0) return true;
    if (p.x() < 1.2 || p.x() >= 1.2 + treads * tread_m || std::abs(p.y()) > 0.6) return false;
    return p.z() <= (std::floor((p.x() - 1.2) / tread_m) + 1) * riser_m;
  }
};

TEST(Treads, OfAFlightAreCountedAndMeasured) {
  for (const Stairs& stairs :
       {Stairs{4, 0.17, 0.28}, Stairs{5, 0.10, 0.27}, Stairs{3, 0.20, 0.25}}) {
    for (const double yaw_deg : {0.0, 12.0}) {
      const Pose T_world_camera = CameraPose(25, yaw_deg);
      const TreadFlight flight = FindTreads(Draw(T_world_camera, stairs), kCamera, T_world_camera);
      SCOPED_TRACE(::testing::Message() << stairs.treads << " treads, yaw " << yaw_deg);
      EXPECT_EQ(flight.treads.size(), static_cast<std::size_t>(stairs.treads));
      EXPECT_NEAR(flight.riser_m, stairs.riser_m, 0.15 * stairs.riser_m);
      EXPECT_NEAR(flight.tread_m, stairs.tread_m, 0.15 * stairs.tread_m);
      EXPECT_GT(flight.direction_world.x(), 0.97);
    }
  }
}

TEST(Treads, OfWhichOnlyTheRisersAreSeenAreCountedToo) {
  const Stairs stairs{5, 0.17, 0.28};
  Pose T_world_camera = CameraPose(0, 0);
  T_world_camera.translation().z() = 0.45;  // below the third tread
  const TreadFlight flight = FindTreads(Draw(T_world_camera, stairs), kCamera, T_world_camera);
  ASSERT_EQ(flight.treads.size(), 5U);
  EXPECT_GT(flight.treads[0].area_m2, 0);
  EXPECT_EQ(flight.treads[4].area_m2, 0);
  EXPECT_NEAR(flight.riser_m, stairs.riser_m, 0.1 * stairs.riser_m);
  EXPECT_NEAR(flight.tread_m, stairs.tread_m, 0.1 * stairs.tread_m);
}

TEST(Treads, AreFoundByACameraWhosePoseLeans) {
  const Pose T_world_camera = CameraPose(25, 0);
  Pose leaning = T_world_camera;
  leaning.linear() =
      Eigen::AngleAxisd(DegToRad(8), Vector3d(1, 0.6, 0).normalized()) * T_world_camera.linear();
  const TreadFlight flight =
      FindTreads(Draw(T_world_camera, Stairs{4, 0.17, 0.28}), kCamera, leaning);
  EXPECT_EQ(flight.treads.size(), 4U);
  EXPECT_NEAR(flight.riser_m, 0.17, 0.0255);
  EXPECT_NEAR(flight.tread_m, 0.28, 0.042);
}

TEST(Treads, AFloorThatLeansHasNone) {
  const auto is_floor = [](const Vector3d& p) { return p.z() <= 0; };
  for (const double lean_deg : {3.0, 8.0, 14.0}) {
    const Pose T_world_camera = CameraPose(25, 0);
    Pose leaning = T_world_camera;
    leaning.linear() =
        Eigen::AngleAxisd(DegToRad(lean_deg), Vector3d::UnitY()) * T_world_camera.linear();
    DepthImage depth_m = Draw(T_world_camera, is_floor);
    for (float& depth : depth_m.data) {  // steps of disparity, as the first Kinect has them
      const float step_m = 0.003F * depth * depth;
      if (depth > 0) depth = std::round(depth / step_m) * step_m;
    }
    EXPECT_TRUE(FindTreads(depth_m, kCamera, leaning).treads.empty()) << lean_deg;
  }
}

TEST(Treads, AMaskLeavesPixelsOut) {
  const Pose T_world_camera = CameraPose(25, 0);
  const DepthImage depth_m = Draw(T_world_camera, Stairs{4, 0.17, 0.28});
  MaskImage mask(depth_m.width, depth_m.height, 0);
  EXPECT_TRUE(FindTreads(depth_m, kCamera, T_world_camera, mask).treads.empty());
  std::fill(mask.data.begin(), mask.data.end(), 1);
  EXPECT_EQ(FindTreads(depth_m, kCamera, T_world_camera, mask).treads.size(), 4U);
}

TEST(Treads, FloorTableAndRampHaveNone) {
  const auto is_table = [](const Vector3d& p) {
    return p.z() <= 0 || (p.x() > 1.5 && p.x() < 2.2 && std::abs(p.y()) < 0.5 && p.z() <= 0.7);
  };
  const auto is_ramp = [](const Vector3d& p) {
    return p.z() <= 0 || (p.x() > 1.2 && p.z() <= 0.5 * (p.x() - 1.2));
  };
  const Pose T_world_camera = CameraPose(25, 0);
  for (const auto& is_solid : {std::function<bool(const Vector3d&)>(is_table),
                               std::function<bool(const Vector3d&)>(is_ramp)})
    EXPECT_TRUE(FindTreads(Draw(T_world_camera, is_solid), kCamera, T_world_camera).treads.empty());
  EXPECT_TRUE(FindTreads(DepthImage(320, 240, 0.0F), kCamera, T_world_camera).treads.empty());
}

}  // namespace
}  // namespace crossnav::geometry
