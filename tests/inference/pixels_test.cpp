// SPDX-License-Identifier: MIT
// Perception from pixels uses pixels only: the simulator's instances do not influence it.
#include <sched.h>

#include <algorithm>

#include "crossnav/inference/suite.h"
#include "crossnav/sim/sensing/simulator.h"
#include "inference/small_network.h"
#include "sim/micro_scene.h"

namespace crossnav::inference::test {
namespace {

class Pixels : public WithBackend {};

TEST_F(Pixels, GarbageInTheInstanceImageChangesNothing) {
  const crossnav::test::TempFolder folder;
  NetworksConfig config = WriteSmallNetwork(folder.path());
  std::string card = SmallCard();
  card.replace(card.find("score = 0.5"), 11, "score = 0.1");  // grey walls are a little red
  crossnav::test::WriteText(folder.path() / "small.toml", card);
  sim::test::MicroScene micro;
  micro.Room(0, 0, 6, 6);
  micro.Begin("armchair", "chair");
  micro.Box({3, 2, 0}, {3.7, 2.7, 0.9});
  const sim::Scene scene = micro.Finish();
  const sim::RayCaster caster(scene);
  const auto navmesh = sim::NavMesh::Build(scene, {});
  ASSERT_TRUE(navmesh);
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = 128;
  sim::Simulator simulator(scene, *navmesh, caster, sensor, {});
  ASSERT_TRUE(simulator.Reset({{1, 3, 0}, 0, 0}));
  simulator.ShowColour(true);

  const auto look = [&](bool with_garbage) {
    const Observation obs = simulator.Observe();
    auto& instance = const_cast<sim::Frame&>(simulator.last_frame()).instance;
    if (with_garbage)
      for (std::size_t i = 0; i < instance.data.size(); ++i)
        instance.data[i] = static_cast<std::int32_t>(i * 2654435761U % 1000);
    auto set = NetworkSet::Read(config, folder.path());
    return set->MakeSuite(sensor.camera_height_m)->Look(obs, "chair");
  };
  const auto honest = look(false), garbage = look(true);
  ASSERT_TRUE(honest) << honest.error().Message();
  ASSERT_TRUE(garbage);
  ASSERT_FALSE(honest->detections.empty());
  ASSERT_EQ(honest->detections.size(), garbage->detections.size());
  for (std::size_t i = 0; i < honest->detections.size(); ++i) {
    EXPECT_EQ(honest->detections[i].box.u0, garbage->detections[i].box.u0);
    EXPECT_EQ(honest->detections[i].confidence, garbage->detections[i].confidence);
    EXPECT_EQ(honest->detections[i].mask.data, garbage->detections[i].mask.data);
  }
  EXPECT_EQ(honest->stair_probability.data, garbage->stair_probability.data);
  EXPECT_EQ(honest->features.data, garbage->features.data);
}

// OpenVINO bound its caller to the first core, which every other process got, too.
TEST_F(Pixels, TheCallerIsNotBoundToACore) {
  const crossnav::test::TempFolder folder;
  const NetworksConfig config = WriteSmallNetwork(folder.path());
  cpu_set_t before{}, after{};
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  auto set = NetworkSet::Read(config, folder.path());
  ASSERT_TRUE(set) << set.error().Message();
  auto suite = set->MakeSuite(0.88);
  ASSERT_TRUE(suite) << suite.error().Message();
  Observation obs;
  obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  obs.rgb = RgbImage(64, 64);
  obs.depth_m = DepthImage(64, 64, 1.0F);
  ASSERT_TRUE(suite->Look(obs, "chair"));
  ASSERT_EQ(sched_getaffinity(0, sizeof(after), &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after)) << "bound to " << CPU_COUNT(&after);
}

}  // namespace
}  // namespace crossnav::inference::test
