// SPDX-License-Identifier: MIT
#include "crossnav/core/colour_grid.h"

#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"

namespace crossnav {
namespace {

/// Colour that says which pixel it is.
RgbImage Numbered(int width, int height) {
  RgbImage rgb(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      rgb.At(u, v) = {static_cast<std::uint8_t>(u + 1), static_cast<std::uint8_t>(v + 1), 200};
  return rgb;
}

/// Depth of 31 x 23 pixels with holes, colour of 64 x 40 from beside and turned.
Observation TwoCameras(std::uint64_t seed) {
  Rng rng(seed);
  Observation obs;
  obs.camera = {31, 23, 27.3, 26.1, 14.2, 11.7};
  obs.depth_m = DepthImage(31, 23);
  for (float& d : obs.depth_m.data) d = static_cast<float>(rng.Uniform(0.4, 6));
  obs.depth_m.At(3, 4) = 0;
  obs.depth_m.At(15, 11) = std::numeric_limits<float>::quiet_NaN();
  obs.depth_m.At(16, 11) = std::numeric_limits<float>::infinity();
  obs.depth_m.At(17, 12) = -1;
  obs.rgb_camera = {64, 40, 47.9, 49.3, 30.8, 20.1};
  obs.rgb = Numbered(64, 40);
  obs.T_camera_rgb.linear() =
      (Eigen::AngleAxisd(rng.Uniform(-0.4, 0.4), Vector3d::UnitY()) *
       Eigen::AngleAxisd(rng.Uniform(-0.2, 0.2), Vector3d(1, 0.3, 2).normalized()))
          .toRotationMatrix();
  obs.T_camera_rgb.translation() =
      Vector3d(rng.Uniform(-0.3, 0.3), rng.Uniform(-0.1, 0.1), rng.Uniform(-0.2, 0.2));
  obs.T_world_camera = CameraPose({Vector3d(1, 2, 3), 0.4, -0.2}, 0.5);
  obs.T_base_camera = CameraPose({Vector3d(0.1, 0, 0), 0, -0.2}, 0.5);
  obs.time_ns = 77;
  return obs;
}

/// Where pixel (u, v) lies in the colour image: the whole chain as one 3 x 4 matrix on homogeneous
/// points. Empty behind the colour camera.
std::optional<Eigen::Vector2d> PlaceInColour(const Observation& obs, int u, int v) {
  Eigen::Matrix3d K_depth, K_rgb;
  K_depth << obs.camera.fx, 0, obs.camera.cx, 0, obs.camera.fy, obs.camera.cy, 0, 0, 1;
  K_rgb << obs.rgb_camera.fx, 0, obs.rgb_camera.cx, 0, obs.rgb_camera.fy, obs.rgb_camera.cy, 0, 0,
      1;
  const float measured = obs.depth_m.At(u, v);
  const double d = measured > 0 && measured < 1e9F ? measured : 10.0;  // NaN compares false
  const Vector3d p_camera = K_depth.inverse() * Vector3d(u * d, v * d, d);
  const Eigen::Matrix<double, 3, 4> P = K_rgb * obs.T_camera_rgb.matrix().inverse().topRows<3>();
  const Vector3d h = P * p_camera.homogeneous();
  if (h.z() <= 0) return std::nullopt;
  return h.hnormalized();
}

TEST(WithColourOnDepthGrid, IsTheNearestSampleOfEveryPixel) {
  int coloured = 0, black = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Observation obs = TwoCameras(seed);
    const Observation out = WithColourOnDepthGrid(obs);
    ASSERT_EQ(out.rgb.width, 31);
    ASSERT_EQ(out.rgb.height, 23);
    for (int v = 0; v < 23; ++v)
      for (int u = 0; u < 31; ++u) {
        Rgb8 expected;
        if (const auto at = PlaceInColour(obs, u, v)) {
          const auto u_rgb = std::lround(at->x()), v_rgb = std::lround(at->y());
          if (std::abs(u_rgb) < 1000 && std::abs(v_rgb) < 1000 &&
              obs.rgb.Contains(static_cast<int>(u_rgb), static_cast<int>(v_rgb)))
            expected = obs.rgb.At(static_cast<int>(u_rgb), static_cast<int>(v_rgb));
        }
        ASSERT_EQ(out.rgb.At(u, v), expected) << seed << ": " << u << ", " << v;
        (expected == Rgb8{} ? black : coloured)++;
      }
  }
  EXPECT_GT(coloured, 5000);
  EXPECT_GT(black, 500);
}

TEST(WithColourOnDepthGrid, LeavesEverythingElseAndTheColourCameraIsGone) {
  const Observation obs = TwoCameras(3);
  const Observation out = WithColourOnDepthGrid(obs);
  EXPECT_FALSE(HasOwnColourGrid(out));
  EXPECT_EQ(out.rgb_camera, CameraIntrinsics{});
  EXPECT_EQ(out.T_camera_rgb.matrix(), Pose::Identity().matrix());
  EXPECT_EQ(out.camera, obs.camera);
  EXPECT_EQ(out.T_world_camera.matrix(), obs.T_world_camera.matrix());
  EXPECT_EQ(out.T_base_camera->matrix(), obs.T_base_camera->matrix());
  EXPECT_EQ(out.time_ns, 77);
  EXPECT_EQ(out.depth_m.data.size(), obs.depth_m.data.size());
  EXPECT_EQ(out.depth_m.At(5, 5), obs.depth_m.At(5, 5));
}

TEST(WithColourOnDepthGrid, TheSameCameraChangesNothing) {
  Observation obs = TwoCameras(1);
  obs.rgb_camera = obs.camera;
  obs.T_camera_rgb = Pose::Identity();
  obs.rgb = Numbered(31, 23);
  EXPECT_EQ(WithColourOnDepthGrid(obs).rgb.data, obs.rgb.data);
}

TEST(WithColourOnDepthGrid, HalfTheColoursSizeTakesEverySecondPixel) {
  Observation obs;
  obs.camera = {4, 3, 5, 5, 1, 1};
  obs.depth_m = DepthImage(4, 3, 2.0F);
  obs.rgb_camera = {8, 6, 10, 10, 2, 2};
  obs.rgb = Numbered(8, 6);
  const Observation out = WithColourOnDepthGrid(obs);
  for (int v = 0; v < 3; ++v)
    for (int u = 0; u < 4; ++u) EXPECT_EQ(out.rgb.At(u, v), obs.rgb.At(2 * u, 2 * v));
}

TEST(WithColourOnDepthGrid, AColourCameraThatLooksAwaySeesNothing) {
  Observation obs = TwoCameras(1);
  obs.T_camera_rgb.linear() =
      Eigen::AngleAxisd(3.141592653589793, Vector3d::UnitY()).toRotationMatrix();
  obs.T_camera_rgb.translation().setZero();
  for (const Rgb8& pixel : WithColourOnDepthGrid(obs).rgb.data) EXPECT_EQ(pixel, Rgb8{});
}

}  // namespace
}  // namespace crossnav
