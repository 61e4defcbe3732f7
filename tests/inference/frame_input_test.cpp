// SPDX-License-Identifier: MIT
#include "crossnav/inference/frame_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "crossnav/core/camera.h"
#include "crossnav/core/pose.h"

namespace crossnav::inference::test {
namespace {

ModelCard::Input InputOf(int width, int height) {
  ModelCard::Input input;
  input.width = width;
  input.height = height;
  return input;
}

TEST(ColourTensor, HasTheCardsLayoutScaleAndOrder) {
  RgbImage rgb(2, 2);
  rgb.At(0, 0) = {255, 0, 51};
  Tensor t = ColourTensor(rgb, InputOf(2, 2), "x");
  EXPECT_EQ(t.shape, (Shape{1, 3, 2, 2}));
  EXPECT_FLOAT_EQ(t.data[0], 1);
  EXPECT_FLOAT_EQ(t.data[4], 0);
  EXPECT_FLOAT_EQ(t.data[8], 0.2F);
  ModelCard::Input input = InputOf(2, 2);
  input.layout = "hwc";
  input.colour = "bgr";
  input.mean = {0.2, 0, 0.5};
  input.deviation = {1, 1, 0.5};
  t = ColourTensor(rgb, input, "x");
  EXPECT_EQ(t.shape, (Shape{1, 2, 2, 3}));
  EXPECT_NEAR(t.data[0], 0, 1e-6);
  EXPECT_NEAR(t.data[2], 1, 1e-6);
}

TEST(ColourTensor, ShrinksLikeATriangleFilterAndKeepsTheMean) {
  RgbImage rgb(8, 8);
  for (int v = 0; v < 8; ++v)
    for (int u = 0; u < 8; ++u) rgb.At(u, v).r = static_cast<std::uint8_t>(u % 2 == 0 ? 200 : 100);
  const Tensor t = ColourTensor(rgb, InputOf(2, 2), "x");
  // Weights 5 7 7 5 3 1 of the first six columns, as Pillow's bilinear filter has them.
  EXPECT_NEAR(t.data[0] * 255, (200 * (5 + 7 + 3) + 100 * (7 + 5 + 1)) / 28.0, 1e-3);
  EXPECT_NEAR(t.data[1] * 255, (200 * (1 + 5 + 7) + 100 * (3 + 7 + 5)) / 28.0, 1e-3);
}

TEST(ColourTensor, ALetterboxKeepsTheShapeAndPadsWithGrey) {
  ModelCard::Input input = InputOf(8, 8);
  input.resize = "letterbox";
  const Placement at = PlacementOf(input, 8, 4);
  EXPECT_EQ(at.offset_y, 2);
  EXPECT_EQ(at.scale_x, 1);
  const Tensor t = ColourTensor(RgbImage(8, 4, Rgb8{255, 255, 255}), input, "x");
  EXPECT_FLOAT_EQ(t.data[0], 114 / 255.0F);
  EXPECT_FLOAT_EQ(t.data[2 * 8], 1);
  EXPECT_FLOAT_EQ(t.data[6 * 8], 114 / 255.0F);
  const auto box = at.ToFrame(1, 3, 5, 9, 8, 4);
  EXPECT_EQ(box.u0, 1);
  EXPECT_EQ(box.v0, 1);
  EXPECT_EQ(box.v1, 4);
}

TEST(DepthTensor, TakesTheNearestPixelAndDropsInvalidDepth) {
  Observation obs;
  obs.depth_m = DepthImage(4, 4, 1.0F);
  obs.depth_m.At(3, 1) = 2;
  obs.depth_m.At(1, 1) = std::numeric_limits<float>::quiet_NaN();
  obs.depth_m.At(1, 3) = -1;
  const Tensor t = DepthTensor(obs, InputOf(2, 2), "d");
  EXPECT_EQ(t.data, (std::vector<float>{0, 2, 0, 1}));
}

TEST(DepthTensor, OfTheCardsFocalLengthTimesPixelsIsTheSizeInMetres) {
  ModelCard::Input input = InputOf(64, 64);
  input.focal_px = 32;
  for (const double hfov_deg : {90.0, 60.0}) {
    Observation obs;
    obs.camera = IntrinsicsFromHfov(128, 128, DegToRad(hfov_deg));
    obs.rgb = RgbImage(128, 128);
    obs.depth_m = DepthImage(128, 128, 2.0F);
    const double sofa_px =
        1.4 / 2 * obs.camera.fx * 64 / 128;  // 1.4 m wide, 2 m away, in the input
    EXPECT_NEAR(sofa_px * DepthTensor(obs, input, "d").data[0] / 32, 1.4, 1e-5);
  }
}

TEST(HeightTensor, IsTheHeightAboveTheFootAtAnyPose) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(8, 8, DegToRad(90));
  obs.rgb = RgbImage(8, 8);
  obs.depth_m = DepthImage(8, 8);
  const AgentPose agent{Vector3d(1, 2, 3.5), 0.7, DegToRad(-30)};
  obs.T_world_camera = CameraPose(agent, 0.88);
  // A floor at the foot: every measured pixel has height 0.
  for (int v = 0; v < 8; ++v)
    for (int u = 0; u < 8; ++u) {
      const Vector3d ray = obs.T_world_camera.linear() * BackProjectPixel(obs.camera, u, v, 1.0);
      if (ray.z() < -0.1) obs.depth_m.At(u, v) = static_cast<float>(-0.88 / ray.z());
    }
  const Tensor t = HeightTensor(obs, 0.88, InputOf(8, 8), "height");
  for (const float h : t.data) EXPECT_NEAR(h, 0, 1e-5);
  // A point 1 m straight ahead of a level camera is as high as the camera.
  obs.T_world_camera = CameraPose({Vector3d(1, 2, 3.5), 0.7, 0}, 0.88);
  obs.depth_m = DepthImage(8, 8, 1.0F);
  const Tensor level = HeightTensor(obs, 0.88, InputOf(8, 8), "height");
  EXPECT_NEAR(level.data[3 * 8] + level.data[4 * 8], 2 * 0.88, 1e-5);
  EXPECT_GT(level.data[0], level.data[7 * 8]);
}

TEST(HeightTensor, UsesTheMountingIfThereIsOne) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(8, 8, DegToRad(90));
  obs.depth_m = DepthImage(8, 8, 1.0F);
  obs.T_world_camera = CameraPose({Vector3d(1, 2, 3.5), 0.7, 0}, 0.6);
  obs.T_base_camera = CameraPose({Vector3d(0.2, 0, 0), 0.1, 0}, 0.6);
  const Tensor t = HeightTensor(obs, 0.88, InputOf(8, 8), "height");
  EXPECT_NEAR(t.data[3 * 8] + t.data[4 * 8], 2 * 0.6, 1e-5);
}

TEST(ToFrameSize, InterpolatesBetweenCellCentres) {
  const float map[] = {0, 1, 2, 3};
  const ModelCard::Input input = InputOf(4, 4);
  const auto image = ToFrameSize(map, 2, 2, PlacementOf(input, 8, 8), input, 8, 8);
  EXPECT_FLOAT_EQ(image.At(0, 0), 0);
  EXPECT_FLOAT_EQ(image.At(7, 7), 3);
  EXPECT_FLOAT_EQ(image.At(3, 0), 0.375F);
  EXPECT_FLOAT_EQ(image.At(4, 0), 0.625F);
  const auto boxed = ToFrameSize(map, 2, 2, PlacementOf(input, 8, 8), input, 8, 8, {4, 0, 6, 2});
  EXPECT_FLOAT_EQ(boxed.At(4, 0), 0.625F);
  EXPECT_FLOAT_EQ(boxed.At(3, 0), 0);
}

}  // namespace
}  // namespace crossnav::inference::test
