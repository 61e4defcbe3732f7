// SPDX-License-Identifier: MIT
#include "crossnav/watch/watch.h"

#include <gtest/gtest.h>

#include "trace/sample_episode.h"
#include "watch/http_client.h"

namespace crossnav::watch {
namespace {

int PortOf(const Watch& watch) {
  const std::string address = watch.address();
  return std::stoi(address.substr(address.rfind(':') + 1));
}

const trace::SampleEpisode& Episode() {
  static const trace::SampleEpisode episode = trace::MakeSampleEpisode(64);
  return episode;
}

void AddSteps(Watch& watch, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    const trace::SampleFrame& frame = Episode().frames[i];
    ASSERT_TRUE(watch.Add({frame.trace, &frame.observation, &frame.sight}));
  }
}

TEST(Watch, AViewerIsToldTheHeadEachStepAndTheEnd) {
  const auto watch = Watch::Open({}).value();
  ASSERT_TRUE(watch->Start(Episode().info));
  AddSteps(*watch, 0, 5);
  Connection viewer(PortOf(*watch));
  viewer.Get("/events");
  viewer.Until("event: head");  // the server knows of it
  AddSteps(*watch, 5, 8);
  ASSERT_TRUE(watch->AddStage(Episode().stages.front()));
  watch->Close(5);
  const std::string& got = viewer.Until("no such text");
  EXPECT_EQ(CountOf(got, "event: head\ndata: {\"info\":{"), 1);
  EXPECT_EQ(CountOf(got, "event: step\ndata: {\"step\":{\"step\":"), 8);
  EXPECT_EQ(CountOf(got, "event: stage\n"), 1);
  EXPECT_EQ(CountOf(got, "event: end\n"), 1);
  for (const char* key :
       {"\"image\":\"/9j/", "\"depth\":\"iVBOR", "\"maps\":\"iVBOR", "\"runs\":\""})
    EXPECT_GT(CountOf(got, key), 0) << key;
}

TEST(Watch, ThePageFollowsTheEventsOfItsOwnServer) {
  const auto watch = Watch::Open({}).value();
  Connection browser(PortOf(*watch));
  browser.Get("/");
  EXPECT_NE(
      browser.Until("</html>").find("type=\"application/json\">{\"live\":\"events\"}</script>"),
      std::string::npos);
}

TEST(Watch, ALogThatIsFullBeginsAnewWithTheMapAsItIs) {
  WatchOptions options;
  options.max_log_bytes = 20000;
  const auto watch = Watch::Open(options).value();
  ASSERT_TRUE(watch->Start(Episode().info));
  Connection early(PortOf(*watch));
  early.Get("/events");
  early.Until("event: head");
  AddSteps(*watch, 0, 40);
  Connection late(PortOf(*watch));
  late.Get("/events");
  const std::string& got = late.Until("\"step\":39,");
  EXPECT_EQ(CountOf(got, "event: head"), 1);
  EXPECT_EQ(CountOf(got, "\"step\":0,"), 0);
  EXPECT_EQ(CountOf(got, "\"step\":39,"), 1);
  // The head's map is not empty.
  const std::size_t head = got.find("\"runs\":\"");
  EXPECT_GT(got.find('"', head + 8) - head, 200U);
  EXPECT_EQ(CountOf(early.Until("\"step\":39,"), "\"step\":39,"), 1);
}

TEST(Watch, AnAgentThatStartsFromAMapShowsIt) {
  const auto watch = Watch::Open({}).value();
  geometry::VoxelMap map;
  const auto& obs = Episode().frames.front().observation;
  map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  map.UpdateStates();
  ASSERT_TRUE(watch->Start(Episode().info, &map));
  Connection viewer(PortOf(*watch));
  viewer.Get("/events");
  const std::string& got = viewer.Until("\n\n");
  EXPECT_EQ(CountOf(got, "\"runs\":\"\""), 0);
}

}  // namespace
}  // namespace crossnav::watch
