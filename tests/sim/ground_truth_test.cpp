// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/ground_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "crossnav/perception/goal_picture.h"
#include "micro_scene.h"

namespace crossnav::sim::test {
namespace {

struct TruthWorld {
  Scene scene;
  RayCaster caster{scene};
  NavMesh navmesh;
  Simulator simulator;
  int near_chair = 0, far_chair = 0;

  static Scene Make() {
    MicroScene m;
    m.Room(0, 0, 14, 6);
    m.Begin("armchair", "chair");
    m.Box({4, 2, 0}, {4.7, 2.7, 0.9});
    m.Begin("chair", "chair");
    m.Box({12, 4, 0}, {12.5, 4.5, 0.9});
    m.Begin("stool");
    m.Box({4, 4, 0}, {4.5, 4.5, 0.6});
    m.Begin("stairs");
    m.Box({8, 0, 0}, {9, 1, 0.2});
    return m.Finish();
  }

  TruthWorld()
      : scene(Make()),
        navmesh(std::move(*NavMesh::Build(scene, {}))),
        simulator(scene, navmesh, caster, Sensor(), {}) {
    for (const SceneInstance& i : scene.instances) {
      if (i.name == "armchair") near_chair = i.id;
      if (i.name == "chair") far_chair = i.id;
    }
    EXPECT_TRUE(simulator.Reset({{1, 3, 0}, 0, 0}).has_value());
  }
  static SensorConfig Sensor() {
    SensorConfig sensor;
    sensor.width_px = sensor.height_px = 320;
    return sensor;
  }
};

TEST(GroundTruth, DetectsTrueInstancesWithTheirTightBoxes) {
  TruthWorld w;
  GroundTruthConfig config;
  config.max_distance_m = 20;
  config.min_visible_px = 20;
  const Observation obs = w.simulator.Observe();
  auto suite = *GroundTruthPerception(w.simulator, config);
  const auto found = suite.detector->Detect(obs, "chair");
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->size(), 2U);
  EXPECT_GE((*found)[0].confidence, (*found)[1].confidence);
  EXPECT_GT((*found)[0].box.Area(), (*found)[1].box.Area());
  for (perception::Detection d : *found) {
    ASSERT_TRUE(suite.segmenter->Segment(obs, d).has_value());
    int u0 = 1 << 30, v0 = 1 << 30, u1 = 0, v1 = 0;
    std::int32_t id = 0;
    for (int v = 0; v < d.mask.height; ++v) {
      for (int u = 0; u < d.mask.width; ++u) {
        if (d.mask.At(u, v) == 0) continue;
        u0 = std::min(u0, u), v0 = std::min(v0, v), u1 = std::max(u1, u + 1),
        v1 = std::max(v1, v + 1);
        const std::int32_t here = w.simulator.last_frame().instance.At(u, v);
        ASSERT_TRUE(id == 0 || id == here);
        id = here;
      }
    }
    EXPECT_EQ(u0, d.box.u0);
    EXPECT_EQ(v0, d.box.v0);
    EXPECT_EQ(u1, d.box.u1);
    EXPECT_EQ(v1, d.box.v1);
    EXPECT_EQ(w.scene.FindInstance(id)->category, "chair");
    EXPECT_EQ(d.mask_quality, 1);
  }
}

TEST(GroundTruth, InstancesOfAFrameAreTheSumsOfItsPixels) {
  TruthWorld w;
  ASSERT_FALSE(w.simulator.Observe().depth_m.empty());
  const Frame& frame = w.simulator.last_frame();
  std::map<int, SeenInstance> expected;
  for (int v = 0; v < frame.instance.height; ++v)
    for (int u = 0; u < frame.instance.width; ++u)
      if (const int id = frame.instance.At(u, v); id != 0)
        expected[id].Add(u, v, frame.depth_m.At(u, v));
  const std::map<int, SeenInstance> seen = InstancesIn(frame);
  ASSERT_GE(expected.size(), 4U);
  ASSERT_EQ(seen.size(), expected.size());
  for (const auto& [id, want] : expected) {
    ASSERT_TRUE(seen.contains(id));
    const SeenInstance& got = seen.at(id);
    EXPECT_EQ(got.pixels, want.pixels);
    EXPECT_EQ(got.nearest_m, want.nearest_m);
    EXPECT_EQ(got.box.u0, want.box.u0);
    EXPECT_EQ(got.box.v0, want.box.v0);
    EXPECT_EQ(got.box.u1, want.box.u1);
    EXPECT_EQ(got.box.v1, want.box.v1);
  }
}

TEST(GroundTruth, MissesFarAndTinyObjects) {
  TruthWorld w;
  const Observation obs = w.simulator.Observe();
  GroundTruthConfig near;
  near.max_distance_m = 8;
  near.min_visible_px = 1;
  EXPECT_EQ(GroundTruthPerception(w.simulator, near)->detector->Detect(obs, "chair")->size(), 1U);
  GroundTruthConfig large;
  large.max_distance_m = 50;
  large.min_visible_px = 1000000;
  EXPECT_TRUE(GroundTruthPerception(w.simulator, large)->detector->Detect(obs, "chair")->empty());
}

TEST(GroundTruth, ConfidenceGrowsWithApproachAndPassesTheStopThreshold) {
  TruthWorld w;
  auto suite = *GroundTruthPerception(w.simulator, {});
  float last = 0;
  for (int i = 0; i < 8; ++i) {
    const auto found = suite.detector->Detect(w.simulator.Observe(), "chair");
    ASSERT_FALSE(found->empty());
    EXPECT_GE(found->front().confidence, last);
    last = found->front().confidence;
    w.simulator.Step(Action::kMoveForward);
  }
  EXPECT_GE(last, 0.70F);  // object.found_confidence
  EXPECT_LT(last, 1.0F);
}

TEST(GroundTruth, OtherGoalsMatchRawNamesExactly) {
  TruthWorld w;
  const Observation obs = w.simulator.Observe();
  auto suite = *GroundTruthPerception(w.simulator, {});
  EXPECT_EQ(suite.detector->Detect(obs, "stool")->size(), 1U);
  EXPECT_TRUE(suite.detector->Detect(obs, "stoo")->empty());
  EXPECT_TRUE(suite.detector->Detect(obs, "bed")->empty());
}

TEST(GroundTruth, StairPixelsAreExactlyThePixelsOfStairs) {
  TruthWorld w;
  const Observation obs = w.simulator.Observe();
  auto suite = *GroundTruthPerception(w.simulator, {});
  const auto stairs = suite.stairs->SegmentStairs(obs);
  ASSERT_TRUE(stairs.has_value());
  int count = 0;
  for (std::size_t i = 0; i < stairs->data.size(); ++i) {
    const SceneInstance* instance = w.scene.FindInstance(w.simulator.last_frame().instance.data[i]);
    const bool is_stairs = instance != nullptr && instance->name == "stairs";
    EXPECT_EQ(stairs->data[i], is_stairs ? 0.9F : 0.0F);
    count += is_stairs ? 1 : 0;
  }
  EXPECT_GT(count, 20);
}

TEST(GroundTruth, AForeignObservationIsAnErrorNotAGuess) {
  TruthWorld w;
  auto suite = *GroundTruthPerception(w.simulator, {});
  Observation never_rendered;
  EXPECT_EQ(suite.detector->Detect(never_rendered, "chair").error().code, ErrorCode::kMismatch);
  EXPECT_FALSE(suite.stairs->SegmentStairs(never_rendered).has_value());
  perception::Detection detection;
  EXPECT_FALSE(suite.segmenter->Segment(never_rendered, detection).has_value());
}

TEST(GroundTruth, AllPartsWorkTogether) {
  TruthWorld w;
  const Observation obs = w.simulator.Observe();
  auto suite = *GroundTruthPerception(w.simulator, {});
  const auto percept = suite.Look(obs, "chair");
  ASSERT_TRUE(percept.has_value()) << percept.error().Message();
  ASSERT_EQ(percept->detections.size(), 1U);
  EXPECT_FALSE(percept->detections[0].mask.empty());
  EXPECT_EQ(percept->features.dim, 768);  // tab:supp_configuration, "Dense output"
  EXPECT_EQ(percept->features.rows, 24);
  EXPECT_EQ(percept->features.cols, 24);
}

/// A picture of an instance from (2, 2.4), and what ground truth needs of it.
std::pair<perception::GoalPicture, PictureView> PictureOf(const TruthWorld& w, int instance) {
  PictureView view{instance, CameraPose({{2, 2.4, 0}, 0, 0}, 1.2), 80};
  perception::GoalPicture picture;
  picture.rgb = w.caster.Render(IntrinsicsFromHfov(64, 64, DegToRad(80)), view.T_world_camera).rgb;
  return {std::move(picture), view};
}

TEST(GroundTruthPictures, APictureIsReadAsTheInstanceThatItShows) {
  TruthWorld w;
  const auto [picture, view] = PictureOf(w, w.near_chair);
  auto suite =
      *GroundTruthPerception(w.simulator, {}, {{perception::NameOfPicture(picture), view}});
  const auto reading = perception::ReadPicture(suite, picture, {});
  ASSERT_TRUE(reading) << reading.error().Message();
  EXPECT_EQ(reading->category, "chair");
  EXPECT_GT(std::count(reading->mask.data.begin(), reading->mask.data.end(), 1), 50);
  // Its features are nearer to the chair's text than the others of the picture.
  const auto text = *suite.encoder->EncodeText("chair");
  const auto cosine = [&](const std::vector<float>& v) {
    return std::inner_product(v.begin(), v.end(), text.begin(), 0.0);
  };
  EXPECT_GT(cosine(perception::PooledFeature(reading->features, reading->mask)),
            cosine(perception::PooledFeature(reading->features, reading->mask, true)) + 0.1);
}

TEST(GroundTruthPictures, OtherPicturesAndAbsentObjectsAreErrors) {
  TruthWorld w;
  const auto [picture, view] = PictureOf(w, w.near_chair);
  const std::string name = perception::NameOfPicture(picture);
  const auto code = [&](const KnownPictures& known) {
    const auto suite = *GroundTruthPerception(w.simulator, {}, known);
    const auto reading = perception::ReadPicture(suite, picture, {});
    EXPECT_FALSE(reading);
    return reading ? ErrorCode::kIo : reading.error().code;
  };
  EXPECT_EQ(code({}), ErrorCode::kUnsupported);
  EXPECT_EQ(code({{name, {4711, view.T_world_camera, 80}}}), ErrorCode::kMismatch);
  EXPECT_EQ(code({{name, {w.near_chair, CameraPose({{1, 1, 0}, DegToRad(180), 0}, 1.2), 80}}}),
            ErrorCode::kMismatch);
}

}  // namespace
}  // namespace crossnav::sim::test
