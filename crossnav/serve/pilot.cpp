// SPDX-License-Identifier: MIT
#include "crossnav/serve/pilot.h"

#include <utility>

#include "crossnav/agent/observation_check.h"
#include "crossnav/serve/observation.h"

namespace crossnav::serve {
namespace {

Refusal Refused(std::string text) {
  return {Fault::kRefused, std::move(text), 0};
}

/// The agent refused the frame itself, not a result of perception.
bool IsOfObservation(const Error& error) {
  return error.where.rfind("observation.", 0) == 0;
}

}  // namespace

Pilot::Pilot(PilotOptions options)
    : options_(std::move(options)), restore_(options_.has_saved_memory) {}

void Pilot::StartConnection() {
  camera_.reset();
  last_time_ns_ = 0;
}

Reply Pilot::Handle(std::string_view payload) {
  const auto request = ParseRequest(payload);
  if (!request) return Malformed(request.error());
  return std::visit([this](const auto& r) { return Do(r); }, *request);
}

Refusal Pilot::Malformed(const Error& error, std::uint64_t sequence) {
  ++counters_.malformed;
  return {Fault::kMalformed, error.Message(), sequence};
}

Reply Pilot::Do(const Hello& hello) {
  if (hello.protocol != kProtocol)
    return Refused("protocol " + std::to_string(hello.protocol) + "; this server speaks " +
                   std::to_string(kProtocol));
  if (auto ok = CheckCamera(hello.camera); !ok) return Malformed(ok.error());
  const double height_m =
      hello.camera_height_m == 0 ? options_.camera_height_m : hello.camera_height_m;
  if (!(height_m >= 0.01 && height_m <= 5.0))  // the range of sensor.camera_height_m
    return Malformed({ErrorCode::kInvalid, "must be 0.01 to 5 m", "hello.camera_height_m"});
  if (agent_ && height_m != camera_height_m_)
    return Refused("the agent goes on from a camera " + std::to_string(camera_height_m_) +
                   " m above the ground; send Reset to start anew");
  if (!agent_) {
    if (auto ok = StartAgent(height_m); !ok) return Refused(ok.error().Message());
  }
  camera_ = hello.camera;
  return Welcome{
      options_.version,        options_.perception,       options_.goals, options_.action,
      options_.serve.period_s, options_.serve.watchdog_s, state_};
}

Result<void> Pilot::StartAgent(double camera_height_m) {
  const bool is_lost = restore_ && options_.wake_up != nullptr;
  auto made = options_.make_agent(camera_height_m, restore_ && !is_lost);
  if (!made) return tl::unexpected(made.error());
  awakening_.reset();
  T_agent_world_ = Pose::Identity();
  if (is_lost) {
    auto awakening = options_.wake_up(camera_height_m);
    if (!awakening) return tl::unexpected(awakening.error());
    awakening_.emplace(std::move(*awakening));
    state_.pose = PoseState::kLocalising;
  }
  agent_.emplace(std::move(*made));
  camera_height_m_ = camera_height_m;
  return {};
}

Reply Pilot::Do(const SetGoal& request) {
  if (!camera_) return Refused("say Hello first");
  if (request.goal.empty()) return Refused("set_goal.goal: is empty");
  if (auto ok = agent_->SetGoal(request.goal); !ok) return Refused(ok.error().Message());
  ++counters_.goals;
  ++state_.goals;
  state_.goal = request.goal;
  state_.phase = Phase::kSearching;
  return state_;
}

Reply Pilot::Do(const Reset& reset) {
  if (reset.restore && !options_.has_saved_memory)
    return Refused("there is no saved memory: start the server with --memory");
  ++counters_.resets;
  agent_.reset();
  state_ = State{};
  last_.reset();
  last_time_ns_ = 0;
  restore_ = reset.restore;
  if (!camera_) return state_;  // the next Hello makes the agent
  if (auto ok = StartAgent(camera_height_m_); !ok) {
    camera_.reset();
    return Refused(ok.error().Message());
  }
  return state_;
}

std::optional<Refusal> Pilot::OutOfOrder(const RawObservation& raw) {
  const bool is_older =
      raw.time_ns != 0 && raw.time_ns < last_time_ns_ && raw.sequence != state_.last_sequence;
  if (raw.sequence >= state_.last_sequence && !is_older) return std::nullopt;
  ++counters_.late;
  return Refusal{Fault::kLate,
                 "older than the last observation, number " + std::to_string(state_.last_sequence),
                 raw.sequence};
}

Reply Pilot::Do(const RawObservation& raw) {
  ++counters_.observations;
  const auto malformed = [&](std::string what, std::string where) {
    return Malformed({ErrorCode::kMalformed, std::move(what), std::move(where)}, raw.sequence);
  };
  if (!camera_) return malformed("say Hello first", "observation");
  if (raw.sequence == 0) return malformed("numbers start at 1", "observation.sequence");
  if (auto refusal = OutOfOrder(raw)) return *refusal;
  if (last_ && raw.sequence == last_->sequence) {
    ++counters_.repeated;
    return *last_;
  }
  const auto obs = ObservationOf(raw, *camera_);
  if (!obs) return Malformed(obs.error(), raw.sequence);
  Answer answer;
  answer.sequence = raw.sequence;
  answer.time_ns = raw.time_ns;
  if (auto ok = Step(*obs, &answer); !ok) {
    if (IsOfObservation(ok.error())) return Malformed(ok.error(), raw.sequence);
    ++counters_.failed;
    return Refusal{Fault::kFailed, ok.error().Message(), raw.sequence};
  }
  ++counters_.answered;
  counters_.collisions += raw.has_collided ? 1 : 0;
  if (state_.last_sequence != 0) counters_.dropped += raw.sequence - state_.last_sequence - 1;
  state_.last_sequence = raw.sequence;
  if (raw.time_ns != 0) last_time_ns_ = raw.time_ns;
  answer.state = state_;
  last_ = answer;
  return answer;
}

/// Without a goal the agent is not stepped, and the robot stays where it is.
Result<void> Pilot::Step(Observation obs, Answer* answer) {
  if (state_.phase == Phase::kClaimed && last_) {
    answer->action = Action::kStop;
    answer->p_claimed_world = last_->p_claimed_world;
  }
  if (state_.phase != Phase::kSearching) return {};
  if (awakening_) {
    const auto is_lost = Localise(obs, answer);
    if (!is_lost) return tl::unexpected(is_lost.error());
    if (*is_lost) return {};
  }
  obs.T_world_camera = T_agent_world_ * obs.T_world_camera;
  auto result = agent_->Step(obs);
  if (!result) return tl::unexpected(result.error());
  ++state_.steps;
  if (options_.on_step) options_.on_step(obs, *result, *agent_);
  answer->mode = result->trace.mode;
  answer->reason = result->trace.reason;
  if (result->all_explored) {
    state_.phase = Phase::kExplored;
    return {};
  }
  answer->action = result->action;
  answer->command = CommandOf(result->action, options_.action, options_.serve.period_s);
  if (result->action != Action::kStop) return {};
  state_.phase = Phase::kClaimed;
  if (result->p_claimed_world)
    answer->p_claimed_world = T_agent_world_.inverse() * *result->p_claimed_world;
  return {};
}

Result<bool> Pilot::Localise(const Observation& obs, Answer* answer) {
  if (auto ok = agent::CheckObservation(obs); !ok) return tl::unexpected(ok.error());
  const localization::LocalizeStep step = awakening_->Step(obs);
  if (step.status != localization::Status::kLocalising) {
    if (auto ok = Arrive(step); !ok) return tl::unexpected(ok.error());
    return false;
  }
  ++state_.steps;
  answer->mode = "localise";
  answer->reason = std::to_string(step.rivals) + " rivals";
  answer->action = step.action;
  answer->command = CommandOf(step.action, options_.action, options_.serve.period_s);
  return true;
}

/// Known: the agent starts from the saved memory, and the goal is set again.
Result<void> Pilot::Arrive(const localization::LocalizeStep& found) {
  T_agent_world_ = awakening_->T_agent_odom();
  awakening_.reset();
  state_.pose = PoseState::kUnknown;
  if (found.status != localization::Status::kKnown) return {};
  auto made = options_.make_agent(camera_height_m_, true);
  if (!made) return tl::unexpected(made.error());
  agent_.emplace(std::move(*made));
  if (auto ok = agent_->SetGoal(state_.goal); !ok) return ok;
  state_.pose = PoseState::kKnown;
  state_.T_map_world = T_agent_world_;
  return {};
}

}  // namespace crossnav::serve
