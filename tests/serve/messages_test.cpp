// SPDX-License-Identifier: MIT
#include "crossnav/serve/messages.h"

#include <gtest/gtest.h>

#include "agent/two_rooms.h"
#include "crossnav/core/rng.h"
#include "serve/live_client.h"

namespace crossnav::serve {
namespace {

Observation SmallView() {
  test::BoxWalker walker = agent::testing::ClosedRoom();
  walker.sensor.width_px = walker.sensor.height_px = 8;
  return walker.Look();
}

live::Reply ReplyOf(const Reply& reply) {
  live::Reply m;
  EXPECT_TRUE(m.ParseFromString(BytesOf(reply)));
  return m;
}

TEST(Messages, EveryFieldOfAnObservationArrives) {
  const Observation obs = SmallView();
  live::Request m = test::ObservationRequest(obs, 7, 1234567890123456789);
  m.mutable_observation()->set_has_collided(true);
  const auto request = ParseRequest(m.SerializeAsString());
  ASSERT_TRUE(request.has_value());
  const auto& raw = std::get<RawObservation>(*request);
  EXPECT_EQ(raw.sequence, 7u);
  EXPECT_EQ(raw.time_ns, 1234567890123456789);
  EXPECT_TRUE(raw.has_collided);
  EXPECT_FALSE(raw.is_depth_mm);
  EXPECT_EQ(raw.rgb, m.observation().rgb());
  EXPECT_EQ(raw.depth, m.observation().depth_m());
  ASSERT_EQ(raw.T_world_camera.size(), 16u);
  EXPECT_EQ(raw.T_world_camera[3], obs.T_world_camera.translation().x());
  m.mutable_observation()->set_depth_mm("ab");
  const auto millimetres = ParseRequest(m.SerializeAsString());
  EXPECT_TRUE(std::get<RawObservation>(*millimetres).is_depth_mm);
  EXPECT_EQ(std::get<RawObservation>(*millimetres).depth, "ab");
}

TEST(Messages, ColourCameraAndMountingArriveWhereTheyAreSent) {
  Observation obs = SmallView();
  const auto plain = ParseRequest(test::ObservationRequest(obs, 1).SerializeAsString());
  EXPECT_FALSE(std::get<RawObservation>(*plain).rgb_camera.has_value());
  EXPECT_TRUE(std::get<RawObservation>(*plain).T_camera_rgb.empty());
  EXPECT_TRUE(std::get<RawObservation>(*plain).T_base_camera.empty());
  obs.rgb_camera = {640, 480, 525, 526, 319.5, 239.5};
  obs.T_camera_rgb.translation() = Vector3d(1, 2, 3);
  obs.T_base_camera = CameraPose({Vector3d(0.2, 0, 0), 0, 0}, 0.6);
  const auto request = ParseRequest(test::ObservationRequest(obs, 1).SerializeAsString());
  const auto& raw = std::get<RawObservation>(*request);
  EXPECT_EQ(raw.rgb_camera, obs.rgb_camera);
  ASSERT_EQ(raw.T_camera_rgb.size(), 16u);
  EXPECT_EQ(raw.T_camera_rgb[7], 2);
  ASSERT_EQ(raw.T_base_camera.size(), 16u);
  EXPECT_EQ(raw.T_base_camera[3], 0.2);
  EXPECT_EQ(raw.T_base_camera[11], 0.6);
}

TEST(Messages, TheOtherRequestsArrive) {
  const CameraIntrinsics K{640, 480, 525, 526, 319.5, 239.5};
  const auto hello = ParseRequest(test::HelloRequest(K, 0.6).SerializeAsString());
  EXPECT_EQ(std::get<Hello>(*hello).camera, K);
  EXPECT_EQ(std::get<Hello>(*hello).protocol, 1u);
  EXPECT_EQ(std::get<Hello>(*hello).camera_height_m, 0.6);
  const auto goal = ParseRequest(test::GoalRequest("sofa").SerializeAsString());
  EXPECT_EQ(std::get<SetGoal>(*goal).goal, "sofa");
  const auto reset = ParseRequest(test::ResetRequest(true).SerializeAsString());
  EXPECT_TRUE(std::get<Reset>(*reset).restore);
  const auto stats = ParseRequest(test::StatsRequest().SerializeAsString());
  EXPECT_TRUE(std::holds_alternative<GetStats>(*stats));
}

TEST(Messages, AnAnswerIsWrittenWhole) {
  Answer answer;
  answer.sequence = 9;
  answer.time_ns = -3;
  answer.action = Action::kTurnRight;
  answer.command = {0, -0.5, 0, 1};
  answer.state = {Phase::kClaimed, "bed", 2, 40, 9};
  answer.mode = "approach";
  answer.reason = "goal seen";
  answer.p_claimed_world = Vector3d(1, 2, 3);
  const live::Answer m = ReplyOf(answer).answer();
  EXPECT_EQ(m.sequence(), 9u);
  EXPECT_EQ(m.time_ns(), -3);
  EXPECT_EQ(m.action(), live::ACTION_TURN_RIGHT);
  EXPECT_EQ(m.command().w_radps(), -0.5);
  EXPECT_EQ(m.command().duration_s(), 1);
  EXPECT_EQ(m.state().phase(), live::PHASE_CLAIMED);
  EXPECT_EQ(m.state().goal(), "bed");
  EXPECT_EQ(m.state().goals(), 2u);
  EXPECT_EQ(m.state().steps(), 40u);
  EXPECT_EQ(m.state().last_sequence(), 9u);
  EXPECT_EQ(m.mode(), "approach");
  EXPECT_EQ(m.reason(), "goal seen");
  ASSERT_EQ(m.p_claimed_world_size(), 3);
  EXPECT_EQ(m.p_claimed_world(2), 3);
}

TEST(Messages, ActionsAndFaultsHaveTheirNamesOnTheWire) {
  const std::pair<Action, live::Action> actions[] = {
      {Action::kMoveForward, live::ACTION_MOVE_FORWARD},
      {Action::kTurnLeft, live::ACTION_TURN_LEFT},
      {Action::kTurnRight, live::ACTION_TURN_RIGHT},
      {Action::kLookUp, live::ACTION_LOOK_UP},
      {Action::kLookDown, live::ACTION_LOOK_DOWN},
      {Action::kStop, live::ACTION_STOP}};
  for (const auto& [ours, wire] : actions) {
    Answer answer;
    answer.action = ours;
    EXPECT_EQ(ReplyOf(answer).answer().action(), wire);
  }
  EXPECT_EQ(ReplyOf(Answer{}).answer().action(), live::ACTION_NONE);
  const std::pair<Fault, live::Fault> faults[] = {
      {Fault::kMalformed, live::FAULT_MALFORMED}, {Fault::kLate, live::FAULT_LATE},
      {Fault::kBusy, live::FAULT_BUSY},           {Fault::kReplaced, live::FAULT_REPLACED},
      {Fault::kRefused, live::FAULT_REFUSED},     {Fault::kFailed, live::FAULT_FAILED}};
  for (const auto& [ours, wire] : faults)
    EXPECT_EQ(ReplyOf(Refusal{ours, "why", 3}).error().fault(), wire);
  EXPECT_EQ(ReplyOf(State{Phase::kExplored, {}, 0, 0, 0}).state().phase(), live::PHASE_EXPLORED);
}

TEST(Messages, EveryCounterIsWritten) {
  Counters counters;
  std::uint64_t next = 0, sum = 0;
  Visit([&](const char*, std::uint64_t& count) { count = ++next; }, counters);
  const live::Stats m = ReplyOf(counters).stats();
  for (const std::uint64_t count :
       {m.connections(), m.refused(), m.replaced(), m.observations(), m.answered(), m.repeated(),
        m.late(), m.dropped(), m.malformed(), m.failed(), m.collisions(), m.goals(), m.resets(),
        m.stops()})
    sum += count;
  EXPECT_EQ(next, 14u);
  EXPECT_EQ(sum, next * (next + 1) / 2);
}

TEST(Messages, BytesThatAreNoRequestAreAnError) {
  EXPECT_FALSE(ParseRequest("").has_value());
  EXPECT_FALSE(ParseRequest(std::string("\x00", 1)).has_value());
  EXPECT_FALSE(ParseRequest("no message at all").has_value());
  EXPECT_FALSE(ParseRequest("\x12\x05\x0a\x03\xff\xfe\xfd").has_value());  // a goal, not UTF-8
}

TEST(Messages, DamagedBytesAreARequestOrAnErrorAndNeverMore) {
  const std::string good = test::ObservationRequest(SmallView(), 7).SerializeAsString();
  for (std::size_t size = 0; size < good.size(); size += 7)
    EXPECT_FALSE(ParseRequest(good.substr(0, size)).has_value()) << size;
  Rng rng(3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes = good;
    for (int i = rng.Int(1, 8); i > 0; --i)
      bytes[static_cast<std::size_t>(rng.Int(0, static_cast<int>(bytes.size()) - 1))] =
          static_cast<char>(rng.Int(0, 255));
    (void)ParseRequest(bytes);
  }
}

}  // namespace
}  // namespace crossnav::serve
