// SPDX-License-Identifier: MIT
// Replies of the server, without a socket.
#include "crossnav/serve/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "serve/couch_pilot.h"
#include "serve/live_client.h"

namespace crossnav::serve {
namespace {

using test::CouchPilot;
using test::GoalRequest;
using test::HelloRequest;
using test::ObservationRequest;
using test::ResetRequest;

/// A pilot that is asked as a client asks it, and the room in which that client stands.
class PilotTest : public ::testing::Test {
 protected:
  live::Reply Ask(const live::Request& request) { return AskBytes(request.SerializeAsString()); }
  live::Reply AskBytes(const std::string& bytes) {
    live::Reply reply;
    EXPECT_TRUE(reply.ParseFromString(BytesOf(pilot_->Handle(bytes))));
    return reply;
  }
  void SayHello() {
    pilot_->StartConnection();
    ASSERT_TRUE(Ask(HelloRequest(walker_.sensor.Intrinsics())).has_welcome());
  }
  void Start() {
    SayHello();
    ASSERT_TRUE(Ask(GoalRequest("couch")).has_state());
  }
  live::Reply Look(std::uint64_t sequence, std::int64_t time_ns = 0) {
    return Ask(ObservationRequest(walker_.Look(), sequence, time_ns));
  }
  void ExpectFault(const live::Reply& reply, live::Fault fault, const std::string& part = "") {
    ASSERT_TRUE(reply.has_error());
    EXPECT_EQ(reply.error().fault(), fault) << reply.error().text();
    EXPECT_NE(reply.error().text().find(part), std::string::npos) << reply.error().text();
  }
  const Counters& counts() { return pilot_->counters(); }

  std::optional<Pilot> pilot_{std::in_place, CouchPilot()};
  test::BoxWalker walker_ = agent::testing::TwoRooms();
};

TEST_F(PilotTest, WelcomeDescribesTheServer) {
  pilot_->StartConnection();
  const live::Reply reply = Ask(HelloRequest(walker_.sensor.Intrinsics()));
  ASSERT_TRUE(reply.has_welcome());
  const live::Welcome& w = reply.welcome();
  EXPECT_EQ(w.protocol(), 1u);
  EXPECT_EQ(w.perception(), "test");
  EXPECT_EQ(w.goals(0), "couch");
  EXPECT_EQ(w.forward_m(), 0.25);
  EXPECT_NEAR(w.turn_rad(), M_PI / 6, 1e-12);
  EXPECT_EQ(w.max_frame_bytes(), 32u << 20);
  EXPECT_EQ(w.state().phase(), live::PHASE_NO_GOAL);
}

TEST_F(PilotTest, NothingWorksBeforeHello) {
  pilot_->StartConnection();
  ExpectFault(Ask(GoalRequest("couch")), live::FAULT_REFUSED, "Hello");
  ExpectFault(Look(1), live::FAULT_MALFORMED, "Hello");
  live::Request other = HelloRequest(walker_.sensor.Intrinsics());
  other.mutable_hello()->set_protocol(2);
  ExpectFault(Ask(other), live::FAULT_REFUSED, "protocol 2");
  ExpectFault(Look(1), live::FAULT_MALFORMED, "Hello");
}

TEST_F(PilotTest, AnInvalidCameraIsMalformed) {
  pilot_->StartConnection();
  const CameraIntrinsics good = walker_.sensor.Intrinsics();
  CameraIntrinsics bad = good;
  bad.width_px = 0;
  ExpectFault(Ask(HelloRequest(bad)), live::FAULT_MALFORMED, "hello.camera");
  bad = good;
  bad.height_px = 100000;
  ExpectFault(Ask(HelloRequest(bad)), live::FAULT_MALFORMED, "hello.camera");
  bad = good;
  bad.fx = 0;
  ExpectFault(Ask(HelloRequest(bad)), live::FAULT_MALFORMED, "hello.camera");
  bad = good;
  bad.cy = std::nan("");
  ExpectFault(Ask(HelloRequest(bad)), live::FAULT_MALFORMED, "hello.camera");
  ExpectFault(Ask(HelloRequest(good, -1)), live::FAULT_MALFORMED, "camera_height_m");
  ExpectFault(Ask(HelloRequest(good, std::nan(""))), live::FAULT_MALFORMED, "camera_height_m");
  EXPECT_EQ(counts().malformed, 6u);
}

TEST_F(PilotTest, WithoutAGoalTheRobotStands) {
  SayHello();
  const live::Reply reply = Look(1);
  ASSERT_TRUE(reply.has_answer());
  EXPECT_EQ(reply.answer().action(), live::ACTION_NONE);
  EXPECT_EQ(reply.answer().command().v_mps(), 0);
  EXPECT_EQ(reply.answer().state().phase(), live::PHASE_NO_GOAL);
  ExpectFault(Ask(GoalRequest("")), live::FAULT_REFUSED, "empty");
}

TEST_F(PilotTest, ActionsAreThoseOfTheAgentAndEndInAClaim) {
  Start();
  agent::Agent direct(agent::testing::SmallConfig(), test::FakeSuite(agent::testing::CouchSight()));
  ASSERT_TRUE(direct.SetGoal("couch").has_value());
  live::Answer last;
  for (std::uint64_t i = 1; i <= 400; ++i) {
    const auto expected = direct.Step(walker_.Look());
    ASSERT_TRUE(expected.has_value());
    const live::Reply reply = Look(i, static_cast<std::int64_t>(i));
    ASSERT_TRUE(reply.has_answer()) << reply.error().text();
    last = reply.answer();
    EXPECT_EQ(last.sequence(), i);
    EXPECT_EQ(last.time_ns(), static_cast<std::int64_t>(i));
    EXPECT_EQ(last.action() - 1, static_cast<int>(expected->action));
    EXPECT_EQ(last.reason(), expected->trace.reason);
    walker_.Do(expected->action);
    if (expected->action != Action::kStop) continue;
    ASSERT_EQ(last.p_claimed_world_size(), 3);
    EXPECT_EQ(last.p_claimed_world(0), expected->p_claimed_world->x());
    break;
  }
  EXPECT_EQ(last.state().phase(), live::PHASE_CLAIMED);
  EXPECT_EQ(last.command().v_mps(), 0);
  // It stands by its word until there is another goal, and takes no step.
  const live::Reply again = Look(1000);
  EXPECT_EQ(again.answer().action(), live::ACTION_STOP);
  EXPECT_EQ(again.answer().p_claimed_world(0), last.p_claimed_world(0));
  EXPECT_EQ(again.answer().state().steps(), last.state().steps());
  EXPECT_EQ(Ask(GoalRequest("bed")).state().phase(), live::PHASE_SEARCHING);
}

TEST_F(PilotTest, ExploredIsNotAClaim) {
  Start();
  walker_ = agent::testing::ClosedRoom();
  live::Reply reply = Ask(GoalRequest("bed"));
  for (std::uint64_t i = 1; i <= 400; ++i) {
    reply = Look(i);
    ASSERT_TRUE(reply.has_answer());
    if (reply.answer().state().phase() != live::PHASE_SEARCHING) break;
    walker_.Do(static_cast<Action>(reply.answer().action() - 1));
  }
  EXPECT_EQ(reply.answer().state().phase(), live::PHASE_EXPLORED);
  EXPECT_EQ(reply.answer().action(), live::ACTION_NONE);
  EXPECT_EQ(reply.answer().command().duration_s(), 0);
}

TEST_F(PilotTest, ARepeatedNumberGetsTheSameAnswerAndNoStep) {
  Start();
  const std::string first = Look(1).SerializeAsString();
  const std::string second = Look(2).SerializeAsString();
  walker_.Do(Action::kTurnLeft);
  EXPECT_EQ(Look(2).SerializeAsString(), second);
  EXPECT_EQ(counts().repeated, 1u);
  EXPECT_EQ(counts().answered, 2u);
  EXPECT_NE(first, second);
}

TEST_F(PilotTest, LateObservationsAreRefusedAndCounted) {
  Start();
  ASSERT_TRUE(Look(5, 500).has_answer());
  ExpectFault(Look(4, 600), live::FAULT_LATE);
  ExpectFault(Look(6, 499), live::FAULT_LATE);
  EXPECT_EQ(counts().late, 2u);
  EXPECT_TRUE(Look(6, 0).has_answer());  // a clock that is not known is not late
  pilot_->StartConnection();             // and the next client's clock may start anew
  ASSERT_TRUE(Ask(HelloRequest(walker_.sensor.Intrinsics())).has_welcome());
  EXPECT_TRUE(Look(7, 1).has_answer());
}

TEST_F(PilotTest, MissingNumbersAreCounted) {
  Start();
  ASSERT_TRUE(Look(10).has_answer());
  EXPECT_EQ(counts().dropped, 0u);  // no rule that it starts at 1
  ASSERT_TRUE(Look(11).has_answer());
  ASSERT_TRUE(Look(15).has_answer());
  EXPECT_EQ(counts().dropped, 3u);
}

TEST_F(PilotTest, MalformedObservationsAreCountedAndLeaveNoTrace) {
  Start();
  ASSERT_TRUE(Look(1).has_answer());
  const live::Request good = ObservationRequest(walker_.Look(), 2);
  const auto refused = [&](const char* part, auto&& change) {
    live::Request bad = good;
    change(*bad.mutable_observation());
    const live::Reply reply = Ask(bad);
    ExpectFault(reply, live::FAULT_MALFORMED, part);
  };
  refused("rgb", [](auto& m) { m.mutable_rgb()->pop_back(); });
  refused("rgb", [](auto& m) { m.clear_rgb(); });
  refused("depth", [](auto& m) { m.mutable_depth_m()->resize(63 * 64 * 4); });
  refused("depth", [](auto& m) { m.clear_depth_m(); });
  refused("depth", [](auto& m) { m.set_depth_mm(std::string(m.depth_m())); });
  refused("T_world_camera", [](auto& m) { m.clear_t_world_camera(); });
  refused("T_world_camera", [](auto& m) { m.set_t_world_camera(3, std::nan("")); });
  refused("T_world_camera", [](auto& m) { m.set_t_world_camera(0, 7); });
  refused("T_world_camera", [](auto& m) { m.set_t_world_camera(15, 2); });
  refused("T_world_camera", [](auto& m) { m.set_t_world_camera(3, 1e9); });
  refused("sequence", [](auto& m) { m.set_sequence(0); });
  ExpectFault(AskBytes("nonsense"), live::FAULT_MALFORMED);
  EXPECT_EQ(counts().malformed, 12u);
  EXPECT_EQ(counts().answered, 1u);
  const live::Reply reply = Ask(good);  // the same number, whole this time
  ASSERT_TRUE(reply.has_answer());
  EXPECT_EQ(reply.answer().state().steps(), 2u);
  EXPECT_EQ(counts().dropped, 0u);
  EXPECT_EQ(counts().observations, counts().answered + counts().malformed - 1);  // the nonsense
}

TEST_F(PilotTest, MillimetresAreMetres) {
  Start();
  Observation obs = walker_.Look();
  std::string depth_mm;
  for (float& depth_m : obs.depth_m.data) {
    const auto mm = static_cast<std::uint16_t>(std::lround(depth_m * 1000));
    depth_m = static_cast<float>(mm) / 1000.0F;
    depth_mm.append(reinterpret_cast<const char*>(&mm), sizeof mm);
  }
  live::Request request = ObservationRequest(obs, 1);
  request.mutable_observation()->set_depth_mm(depth_mm);
  ASSERT_TRUE(Ask(request).has_answer());
  agent::Agent direct(agent::testing::SmallConfig(), test::FakeSuite(agent::testing::CouchSight()));
  ASSERT_TRUE(direct.SetGoal("couch").has_value());
  ASSERT_TRUE(direct.Step(obs).has_value());
  EXPECT_TRUE(agent::testing::BytesOf(*pilot_->agent()) == agent::testing::BytesOf(direct));
}

/// Colour of 40 x 30 pixels from 5 cm beside; the camera sits 0.2 m before the foot.
Observation OfTwoCameras(const test::BoxWalker& walker) {
  Observation obs = walker.Look();
  obs.rgb_camera = IntrinsicsFromHfov(40, 30, DegToRad(60));
  obs.rgb = RgbImage(40, 30, {9, 8, 7});
  obs.T_camera_rgb.translation().x() = 0.05;
  obs.T_base_camera = CameraPose({Vector3d(0.2, 0, 0), 0, 0}, 0.6);
  return obs;
}

TEST_F(PilotTest, ColourCameraAndMountingReachTheAgent) {
  Start();
  const Observation obs = OfTwoCameras(walker_);
  agent::Agent direct(agent::testing::SmallConfig(), test::FakeSuite(agent::testing::CouchSight()));
  ASSERT_TRUE(direct.SetGoal("couch").has_value());
  const auto expected = direct.Step(obs);
  ASSERT_TRUE(expected.has_value()) << expected.error().Message();
  const live::Reply reply = Ask(ObservationRequest(obs, 1));
  ASSERT_TRUE(reply.has_answer()) << reply.error().text();
  EXPECT_EQ(reply.answer().action() - 1, static_cast<int>(expected->action));
  const auto bytes = agent::testing::BytesOf(*pilot_->agent());
  EXPECT_TRUE(bytes == agent::testing::BytesOf(direct));
  agent::Agent plain(agent::testing::SmallConfig(), test::FakeSuite(agent::testing::CouchSight()));
  ASSERT_TRUE(plain.SetGoal("couch").has_value());
  ASSERT_TRUE(plain.Step(walker_.Look()).has_value());
  EXPECT_FALSE(bytes == agent::testing::BytesOf(plain));  // the body stood elsewhere
}

TEST_F(PilotTest, AnInvalidColourCameraOrMountingNamesItsField) {
  Start();
  const live::Request good = ObservationRequest(OfTwoCameras(walker_), 1);
  const auto refused = [&](const char* part, auto&& change) {
    live::Request bad = good;
    change(*bad.mutable_observation());
    ExpectFault(Ask(bad), live::FAULT_MALFORMED, part);
  };
  refused("observation.rgb:", [](auto& m) { m.clear_rgb_camera(); });
  refused("observation.rgb:", [](auto& m) { m.mutable_rgb_camera()->set_width_px(64); });
  refused("observation.rgb_camera", [](auto& m) { m.mutable_rgb_camera()->set_width_px(0); });
  refused("observation.rgb_camera", [](auto& m) { m.mutable_rgb_camera()->set_fy(0); });
  refused("observation.T_camera_rgb", [](auto& m) { m.set_t_camera_rgb(0, 7); });
  refused("observation.T_camera_rgb", [](auto& m) { m.mutable_t_camera_rgb()->RemoveLast(); });
  refused("observation.T_base_camera", [](auto& m) { m.set_t_base_camera(3, std::nan("")); });
  refused("observation.T_base_camera", [](auto& m) { m.add_t_base_camera(1); });
  refused("observation.T_base_camera", [](auto& m) { m.set_t_base_camera(11, 50); });
  EXPECT_EQ(counts().malformed, 9u);
  EXPECT_TRUE(Ask(good).has_answer());
}

TEST_F(PilotTest, ANewConnectionContinuesTheLast) {
  Start();
  for (std::uint64_t i = 1; i <= 5; ++i) ASSERT_TRUE(Look(i).has_answer());
  const std::string last = Look(5).SerializeAsString();
  pilot_->StartConnection();
  ExpectFault(Look(6), live::FAULT_MALFORMED, "Hello");
  const live::Reply hello = Ask(HelloRequest(walker_.sensor.Intrinsics()));
  EXPECT_EQ(hello.welcome().state().goal(), "couch");
  EXPECT_EQ(hello.welcome().state().steps(), 5u);
  EXPECT_EQ(hello.welcome().state().last_sequence(), 5u);
  EXPECT_EQ(Look(5).SerializeAsString(), last);  // an answer that was lost with the client
  EXPECT_TRUE(Look(6).has_answer());
  EXPECT_EQ(counts().dropped, 0u);
}

TEST_F(PilotTest, AResetForgetsEverything) {
  Start();
  for (std::uint64_t i = 1; i <= 5; ++i) ASSERT_TRUE(Look(i).has_answer());
  ASSERT_GT(pilot_->agent()->map().Stats().known, 0);
  const live::Reply reply = Ask(ResetRequest());
  EXPECT_EQ(reply.state().phase(), live::PHASE_NO_GOAL);
  EXPECT_EQ(reply.state().last_sequence(), 0u);
  EXPECT_EQ(pilot_->agent()->map().Stats().known, 0);
  ASSERT_TRUE(Ask(GoalRequest("couch")).has_state());
  EXPECT_TRUE(Look(1).has_answer());
}

TEST_F(PilotTest, AnotherCameraHeightNeedsAReset) {
  Start();
  pilot_->StartConnection();
  const CameraIntrinsics K = walker_.sensor.Intrinsics();
  ExpectFault(Ask(HelloRequest(K, 0.5)), live::FAULT_REFUSED, "Reset");
  ASSERT_TRUE(Ask(ResetRequest()).has_state());
  ASSERT_TRUE(Ask(HelloRequest(K, 0.5)).has_welcome());
  EXPECT_EQ(pilot_->agent()->config().sensor.camera_height_m, 0.5);
}

TEST_F(PilotTest, ARestoreNeedsASavedMemory) {
  Start();
  ExpectFault(Ask(ResetRequest(true)), live::FAULT_REFUSED, "--memory");
  EXPECT_NE(pilot_->agent(), nullptr);
  std::vector<bool> starts;
  PilotOptions options = CouchPilot();
  options.has_saved_memory = true;
  options.make_agent = [&](double height_m, bool restore) {
    starts.push_back(restore);
    return test::MakeCouchAgent(height_m);
  };
  pilot_.emplace(options);
  SayHello();
  Ask(ResetRequest(false));
  Ask(ResetRequest(true));
  EXPECT_EQ(starts, (std::vector<bool>{true, false, true}));
}

TEST_F(PilotTest, AFailingNetworkIsAnErrorOfTheStepAlone) {
  PilotOptions options = CouchPilot();
  options.make_agent = [](double, bool) -> Result<agent::Agent> {
    test::FakeSight sight;
    sight.failing = "detector";
    return agent::Agent(agent::testing::SmallConfig(), test::FakeSuite(sight));
  };
  pilot_.emplace(options);
  Start();
  ExpectFault(Look(1), live::FAULT_FAILED, "detector");
  EXPECT_EQ(counts().failed, 1u);
  EXPECT_EQ(counts().observations, 1u);
}

TEST(Command, ActionsAreSpreadOverThePeriod) {
  const ActionConfig sizes;
  EXPECT_EQ(CommandOf(Action::kMoveForward, sizes, 0.5), (Command{0.5, 0, 0, 0.5}));
  const Command left = CommandOf(Action::kTurnLeft, sizes, 2);
  EXPECT_NEAR(left.w_radps * left.duration_s, DegToRad(30), 1e-12);
  EXPECT_EQ(CommandOf(Action::kTurnRight, sizes, 2).w_radps, -left.w_radps);
  EXPECT_GT(CommandOf(Action::kLookUp, sizes, 1).pitch_radps, 0);
  EXPECT_LT(CommandOf(Action::kLookDown, sizes, 1).pitch_radps, 0);
  EXPECT_EQ(CommandOf(Action::kStop, sizes, 1), Command{});
}

TEST_F(PilotTest, EachStepOfTheAgentIsToldOnceToWhoWatches) {
  std::vector<int> steps;
  auto options = CouchPilot();
  options.on_step = [&steps](const Observation& obs, const agent::StepResult& result,
                             const agent::Agent& agent) {
    EXPECT_FALSE(obs.depth_m.empty());
    EXPECT_GT(agent.map().Stats().known, 0);
    steps.push_back(result.trace.step);
  };
  pilot_.emplace(std::move(options));
  Start();
  Look(1);
  Look(1);  // again: the same answer, no step
  Look(3);
  EXPECT_EQ(steps, (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace crossnav::serve
