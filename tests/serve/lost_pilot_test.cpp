// SPDX-License-Identifier: MIT
// A server whose robot wakes up in its saved map without its pose.
#include <gtest/gtest.h>

#include "crossnav/serve/pilot.h"
#include "localization/lost_robot.h"
#include "serve/couch_pilot.h"
#include "serve/live_client.h"

namespace crossnav::serve {
namespace {

TEST(LostPilot, RobotIsLocalisedBeforeItSearches) {
  test::BoxWalker walker = agent::testing::TwoRooms();
  std::vector<bool> starts;  // with the saved memory, or without
  PilotOptions options = test::CouchPilot();
  options.has_saved_memory = true;
  options.make_agent = [&](double camera_height_m, bool restore) {
    starts.push_back(restore);
    return test::MakeCouchAgent(camera_height_m);
  };
  options.wake_up = [&](double camera_height_m) {
    return localization::Awakening::In(test::MapOf(walker.rooms),
                                       {camera_height_m, walker.action, {}});
  };
  Pilot pilot(options);
  const auto ask = [&](const live::Request& request) {
    live::Reply reply;
    EXPECT_TRUE(reply.ParseFromString(BytesOf(pilot.Handle(request.SerializeAsString()))));
    return reply;
  };
  pilot.StartConnection();
  ASSERT_TRUE(ask(test::HelloRequest(walker.sensor.Intrinsics())).has_welcome());
  ASSERT_TRUE(ask(test::GoalRequest("couch")).has_state());
  const Pose T_odom_world = localization::FootFrameOf(walker.pose).inverse();
  live::State state;
  for (std::uint64_t sequence = 1; sequence <= 40; ++sequence) {
    Observation obs = walker.Look();
    obs.T_world_camera = T_odom_world * obs.T_world_camera;
    const live::Reply reply = ask(test::ObservationRequest(obs, sequence, 0));
    ASSERT_TRUE(reply.has_answer()) << reply.error().text();
    state = reply.answer().state();
    if (state.pose() != live::POSE_LOCALISING) break;
    EXPECT_EQ(reply.answer().mode(), "localise");
    ASSERT_EQ(reply.answer().action(), live::ACTION_TURN_LEFT);
    walker.Do(Action::kTurnLeft);
  }
  EXPECT_EQ(state.pose(), live::POSE_KNOWN);
  EXPECT_EQ(starts, (std::vector<bool>{false, true}));
  ASSERT_EQ(state.t_map_world_size(), 16);
  EXPECT_NEAR(state.t_map_world(3), T_odom_world.inverse().translation().x(), 0.25);
  EXPECT_NEAR(state.t_map_world(7), T_odom_world.inverse().translation().y(), 0.25);
}

}  // namespace
}  // namespace crossnav::serve
