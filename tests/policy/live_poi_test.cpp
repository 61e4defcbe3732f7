// SPDX-License-Identifier: MIT
#include "crossnav/policy/live_poi.h"

#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "crossnav/policy/clusters.h"
#include "support/sightings.h"

namespace crossnav::policy {
namespace {

constexpr int kSide_px = 64;

/// A camera at the origin that looks along world +x at a plane 2 m away.
Observation Wall(float depth_m = 2.0F) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(kSide_px, kSide_px, DegToRad(90));
  obs.rgb = RgbImage(kSide_px, kSide_px);
  obs.depth_m = DepthImage(kSide_px, kSide_px, depth_m);
  obs.T_world_camera = CameraPose({}, 0.88);
  return obs;
}

perception::Detection DetectionOf(perception::PixelBox box, float confidence = 0.9F) {
  perception::Detection detection;
  detection.box = box;
  detection.confidence = confidence;
  detection.mask_quality = 0.8F;
  detection.mask = MaskImage(kSide_px, kSide_px, 0);
  for (int v = std::max(0, box.v0); v < std::min(kSide_px, box.v1); ++v)
    for (int u = std::max(0, box.u0); u < std::min(kSide_px, box.u1); ++u)
      detection.mask.At(u, v) = 1;
  return detection;
}

std::vector<Sighting> Lift(const perception::Detection& detection, const Observation& obs) {
  return LiftDetections({detection}, obs, {}, {}, 0.6);
}

std::vector<VoxelKey> CubeAt(int x, int side = 3) {
  std::vector<VoxelKey> keys;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k) keys.push_back({x + i, j, k});
  return keys;
}

Sighting SightingOf(std::vector<VoxelKey> voxels, double confidence = 0.8, double area = 0.1) {
  return test::SightingOf(std::move(voxels), confidence, area);
}

TEST(LiftDetections, VoxelsComeFromTheMaskedPixels) {
  const Observation obs = Wall();
  const auto sightings = Lift(DetectionOf({20, 24, 44, 40}), obs);
  ASSERT_EQ(sightings.size(), 1u);
  std::set<VoxelKey> expected;
  for (int v = 24; v < 40; ++v)
    for (int u = 20; u < 44; ++u) {
      // Straight from the pinhole: 2 m ahead along x, left is +y, up is +z.
      const Vector3d p(2.0F, -(u - 31.5) * 2.0 / 32, 0.88 - (v - 31.5) * 2.0 / 32);
      expected.insert(geometry::KeyOf(p, 0.1));
    }
  EXPECT_EQ(sightings[0].voxels, std::vector<VoxelKey>(expected.begin(), expected.end()));
  EXPECT_NEAR(sightings[0].area_fraction, 24.0 * 16 / (64 * 64), 1e-12);
  EXPECT_NEAR(sightings[0].confidence, 0.9, 1e-6);
  EXPECT_NEAR(sightings[0].mask_quality, 0.8, 1e-6);
}

TEST(LiftDetections, BelowTheConfidenceNothingIsLifted) {
  EXPECT_TRUE(Lift(DetectionOf({20, 24, 44, 40}, 0.59F), Wall()).empty());
  EXPECT_EQ(Lift(DetectionOf({20, 24, 44, 40}, 0.61F), Wall()).size(), 1u);
}

TEST(LiftDetections, FewerThanTenVoxelsAreNothing) {
  // At 2 m a pixel is 6.25 cm wide: a row of n pixels falls into about 0.625 n voxels.
  EXPECT_TRUE(Lift(DetectionOf({20, 30, 32, 31}), Wall()).empty());
  EXPECT_EQ(Lift(DetectionOf({20, 30, 40, 31}), Wall()).size(), 1u);
}

TEST(LiftDetections, TheLargestConnectedPartRepresentsTheObject) {
  Observation obs = Wall(4.0F);
  // The object's front at 2 m in the left two thirds of the mask, the wall behind it in the rest.
  for (int v = 0; v < kSide_px; ++v)
    for (int u = 0; u < 38; ++u) obs.depth_m.At(u, v) = 2.0F;
  const auto sightings = Lift(DetectionOf({14, 20, 42, 44}), obs);
  ASSERT_EQ(sightings.size(), 1u);
  for (const VoxelKey& key : sightings[0].voxels) EXPECT_LT(key.x, 30);
}

TEST(LiftDetections, InvalidDepthIsSkipped) {
  for (const float bad : {0.0F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), 11.0F, -1.0F})
    EXPECT_TRUE(Lift(DetectionOf({10, 10, 50, 50}), Wall(bad)).empty()) << bad;
}

TEST(LiftDetections, ABoxBeyondTheImageIsClipped) {
  EXPECT_EQ(Lift(DetectionOf({-9, -9, 20, 20}), Wall()).size(), 1u);
  EXPECT_EQ(Lift(DetectionOf({50, 50, 99, 99}), Wall()).size(), 1u);
}

TEST(LivePois, AreStableAfterTwoFramesOfDifferentSteps) {
  LivePois pois;
  pois.Update({SightingOf(CubeAt(0)), SightingOf(CubeAt(0))}, {}, 0.1, 4);
  EXPECT_EQ(pois.all().size(), 1u);
  EXPECT_TRUE(pois.Stable({}).empty());  // twice in one frame is one frame
  pois.Update({SightingOf(CubeAt(1))}, {}, 0.1, 9);
  ASSERT_EQ(pois.Stable({}).size(), 1u);
  const LivePoi& poi = *pois.Stable({}).front();
  EXPECT_EQ(poi.frames, 2);
  EXPECT_EQ(poi.last_seen_step, 9);
  EXPECT_EQ(poi.voxels.size(), 36u);  // both cubes
  EXPECT_NEAR((poi.p_center_world - Vector3d(0.2, 0.15, 0.15)).norm(), 0, 1e-9);
}

TEST(LivePois, UnsureAndSmallSightingsDoNotCount) {
  LivePois pois;
  pois.Update({SightingOf(CubeAt(0), 0.69)}, {}, 0.1, 0);
  pois.Update({SightingOf(CubeAt(0), 0.9, 1.0 / 65)}, {}, 0.1, 1);
  EXPECT_TRUE(pois.all().empty());
  pois.Update({SightingOf(CubeAt(0), 0.70, 1.0 / 64)}, {}, 0.1, 2);
  EXPECT_EQ(pois.all().size(), 1u);
}

TEST(LivePois, TwoObjectsApartStayTwoMostConfidentFirst) {
  LivePois pois;
  for (int step = 0; step < 2; ++step)
    pois.Update({SightingOf(CubeAt(0), 0.75), SightingOf(CubeAt(30), 0.95)}, {}, 0.1, step);
  const auto stable = pois.Stable({});
  ASSERT_EQ(stable.size(), 2u);
  EXPECT_NEAR(stable[0]->confidence, 0.95, 1e-12);
  EXPECT_GT(stable[0]->p_center_world.x(), 2.9);
  EXPECT_NE(stable[0]->id, stable[1]->id);
}

TEST(LivePois, DiscardedPoisAreOutUntilForgiven) {
  LivePois pois;
  for (int step = 0; step < 2; ++step) pois.Update({SightingOf(CubeAt(0))}, {}, 0.1, step);
  const int id = pois.Stable({}).front()->id;
  pois.Discard(id);
  EXPECT_TRUE(pois.Stable({}).empty());
  pois.Update({SightingOf(CubeAt(0))}, {}, 0.1, 2);  // seeing it again does not bring it back
  EXPECT_TRUE(pois.Stable({}).empty());
  pois.ForgiveDiscarded();
  EXPECT_EQ(pois.Stable({}).size(), 1u);
  EXPECT_EQ(pois.Find(id)->frames, 3);
  EXPECT_EQ(pois.Find(id + 1), nullptr);
}

TEST(IsSameObject, NearCentresOrAFifthOfTheVoxelsMakeIt) {
  const auto same = [](const std::vector<VoxelKey>& a, const std::vector<VoxelKey>& b) {
    return IsSameObject(a, CentroidOf(a, 0.1), b, CentroidOf(b, 0.1), 0.5);
  };
  EXPECT_TRUE(same(CubeAt(0), CubeAt(4)));
  EXPECT_FALSE(same(CubeAt(0), CubeAt(6)));
  // A long sofa: centres 0.8 m apart, ends overlapping by a fifth or by less.
  std::vector<VoxelKey> left, right, far;
  for (int x = 0; x < 10; ++x) {
    left.push_back({x, 0, 0});
    right.push_back({x + 8, 0, 0});
    far.push_back({x + 9, 0, 0});
  }
  EXPECT_TRUE(same(left, right));
  EXPECT_FALSE(same(left, far));
}

// tab:supp_configuration, "Secondary confidence": enough to go on with an approach, not to begin.
TEST(LivePois, TheApproachedPoiTakesSightingsOfTheSecondaryConfidence) {
  for (const double confidence : {0.59, 0.60, 0.69}) {
    LivePois pois;
    pois.Update({SightingOf(CubeAt(0))}, {}, 0.1, 0);
    const int id = pois.all().front().id;
    const std::size_t before = pois.all().front().voxels.size();
    const Sighting weak = SightingOf(CubeAt(1), confidence);
    pois.Update({weak, SightingOf(CubeAt(40), confidence)}, {}, 0.1, 1);
    EXPECT_EQ(pois.all().front().voxels.size(), before) << confidence;
    pois.Update({weak, SightingOf(CubeAt(40), confidence)}, {}, 0.1, 2, id);
    EXPECT_EQ(pois.all().size(), 1u);
    EXPECT_EQ(pois.all().front().voxels.size() > before, confidence >= 0.60) << confidence;
    EXPECT_EQ(pois.all().front().confidence, 0.8);
  }
}

}  // namespace
}  // namespace crossnav::policy
