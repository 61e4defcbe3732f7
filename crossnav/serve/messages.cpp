// SPDX-License-Identifier: MIT
#include "crossnav/serve/messages.h"

#if __has_include(<google/protobuf/stubs/logging.h>)
#include <google/protobuf/stubs/logging.h>
#define CROSSNAV_PROTOBUF_LOGS
#endif

#include <limits>
#include <utility>

#include "crossnav/serve/framing.h"
#include "live.pb.h"

namespace crossnav::serve {
namespace {

/// 0 for sizes that no image has.
int SizeOf(std::uint32_t value) {
  return value <= static_cast<std::uint32_t>(std::numeric_limits<int>::max())
             ? static_cast<int>(value)
             : 0;
}

CameraIntrinsics CameraOf(const live::Camera& m) {
  return {SizeOf(m.width_px()), SizeOf(m.height_px()), m.fx(), m.fy(), m.cx(), m.cy()};
}

Hello HelloOf(const live::Hello& m) {
  return {m.protocol(), CameraOf(m.camera()), m.camera_height_m()};
}

RawObservation ObservationOf(live::Observation& m) {
  RawObservation raw;
  raw.sequence = m.sequence();
  raw.time_ns = m.time_ns();
  raw.rgb = std::move(*m.mutable_rgb());
  raw.is_depth_mm = m.depth_case() == live::Observation::kDepthMm;
  raw.depth = std::move(raw.is_depth_mm ? *m.mutable_depth_mm() : *m.mutable_depth_m());
  raw.T_world_camera.assign(m.t_world_camera().begin(), m.t_world_camera().end());
  raw.has_collided = m.has_collided();
  if (m.has_rgb_camera()) raw.rgb_camera = CameraOf(m.rgb_camera());
  raw.T_camera_rgb.assign(m.t_camera_rgb().begin(), m.t_camera_rgb().end());
  raw.T_base_camera.assign(m.t_base_camera().begin(), m.t_base_camera().end());
  return raw;
}

live::Action ActionOf(std::optional<Action> action) {
  if (!action) return live::ACTION_NONE;
  switch (*action) {
    case Action::kMoveForward:
      return live::ACTION_MOVE_FORWARD;
    case Action::kTurnLeft:
      return live::ACTION_TURN_LEFT;
    case Action::kTurnRight:
      return live::ACTION_TURN_RIGHT;
    case Action::kLookUp:
      return live::ACTION_LOOK_UP;
    case Action::kLookDown:
      return live::ACTION_LOOK_DOWN;
    case Action::kStop:
      return live::ACTION_STOP;
  }
  return live::ACTION_NONE;
}

void Fill(const Command& command, live::Command* m) {
  m->set_v_mps(command.v_mps);
  m->set_w_radps(command.w_radps);
  m->set_pitch_radps(command.pitch_radps);
  m->set_duration_s(command.duration_s);
}

void Fill(const State& state, live::State* m) {
  m->set_phase(static_cast<live::Phase>(state.phase));
  m->set_goal(state.goal);
  m->set_goals(state.goals);
  m->set_steps(state.steps);
  m->set_last_sequence(state.last_sequence);
  m->set_pose(static_cast<live::PoseState>(state.pose));
  if (!state.T_map_world) return;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      m->add_t_map_world(state.T_map_world->matrix()(row, column));
}

/// Fills the reply's member for the given kind.
struct Writer {
  live::Reply& reply;

  void operator()(const Welcome& welcome) const {
    live::Welcome* m = reply.mutable_welcome();
    m->set_protocol(kProtocol);
    m->set_version(welcome.version);
    m->set_perception(welcome.perception);
    for (const std::string& goal : welcome.goals) m->add_goals(goal);
    m->set_forward_m(welcome.action.forward_m);
    m->set_turn_rad(DegToRad(welcome.action.turn_deg));
    m->set_pitch_rad(DegToRad(welcome.action.pitch_deg));
    m->set_period_s(welcome.period_s);
    m->set_watchdog_s(welcome.watchdog_s);
    m->set_max_frame_bytes(kMaxFrame_bytes);
    Fill(welcome.state, m->mutable_state());
  }
  void operator()(const State& state) const { Fill(state, reply.mutable_state()); }
  void operator()(const Answer& answer) const {
    live::Answer* m = reply.mutable_answer();
    m->set_sequence(answer.sequence);
    m->set_time_ns(answer.time_ns);
    m->set_action(ActionOf(answer.action));
    Fill(answer.command, m->mutable_command());
    Fill(answer.state, m->mutable_state());
    m->set_mode(answer.mode);
    m->set_reason(answer.reason);
    if (!answer.p_claimed_world) return;
    for (const double x : *answer.p_claimed_world) m->add_p_claimed_world(x);
  }
  void operator()(const Counters& c) const {
    live::Stats* m = reply.mutable_stats();
    m->set_connections(c.connections);
    m->set_refused(c.refused);
    m->set_replaced(c.replaced);
    m->set_observations(c.observations);
    m->set_answered(c.answered);
    m->set_repeated(c.repeated);
    m->set_late(c.late);
    m->set_dropped(c.dropped);
    m->set_malformed(c.malformed);
    m->set_failed(c.failed);
    m->set_collisions(c.collisions);
    m->set_goals(c.goals);
    m->set_resets(c.resets);
    m->set_stops(c.stops);
  }
  void operator()(const Refusal& refusal) const {
    live::Error* m = reply.mutable_error();
    m->set_fault(static_cast<live::Fault>(refusal.fault));
    m->set_text(refusal.text);
    m->set_sequence(refusal.sequence);
  }
  void operator()(const Stop& stop) const {
    Fill(Command{}, reply.mutable_stop()->mutable_command());
    reply.mutable_stop()->set_silent_s(stop.silent_s);
  }
};

}  // namespace

Result<Request> ParseRequest(std::string_view bytes) {
#ifdef CROSSNAV_PROTOBUF_LOGS
  google::protobuf::SetLogHandler(nullptr);  // it would print the errors that are returned here
#endif
  live::Request m;
  if (!m.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return Fail(ErrorCode::kMalformed, "the bytes are no Request of live.proto", "frame");
  switch (m.kind_case()) {
    case live::Request::kHello:
      return HelloOf(m.hello());
    case live::Request::kSetGoal:
      return SetGoal{m.set_goal().goal()};
    case live::Request::kObservation:
      return ObservationOf(*m.mutable_observation());
    case live::Request::kReset:
      return Reset{m.reset().restore()};
    case live::Request::kGetStats:
      return GetStats{};
    case live::Request::KIND_NOT_SET:
      break;
  }
  return Fail(ErrorCode::kMalformed, "a Request of no kind that is known here", "frame");
}

std::string BytesOf(const Reply& reply) {
  live::Reply m;
  std::visit(Writer{m}, reply);
  return m.SerializeAsString();
}

}  // namespace crossnav::serve
