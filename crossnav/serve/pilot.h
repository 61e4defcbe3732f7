// SPDX-License-Identifier: MIT
// The agent behind a connection: one request in, one reply out. It outlives connections, so that
// the next client continues after a client's death. Independent of sockets. Not thread-safe.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/agent/agent.h"
#include "crossnav/localization/awakening.h"
#include "crossnav/serve/messages.h"
#include "crossnav/serve/serve_config.h"

namespace crossnav::serve {

/// Program information, and the factory of agents.
struct PilotOptions {
  std::string version, perception;
  std::vector<std::string> goals;  ///< names for which perception is made
  ServeConfig serve;
  ActionConfig action;
  double camera_height_m = 0;  ///< used if Hello has none
  bool has_saved_memory = false;
  /// Creates an agent for a camera at this height above the ground, with or without the saved
  /// memory. The previous agent is destroyed first.
  std::function<Result<agent::Agent>(double camera_height_m, bool restore)> make_agent;
  /// Called after each step of the agent; may be empty.
  std::function<void(const Observation&, const agent::StepResult&, const agent::Agent&)> on_step{};
  /// Set where the robot does not know its pose in the saved memory: it is localised first.
  std::function<Result<localization::Awakening>(double camera_height_m)> wake_up;
};

class Pilot {
 public:
  explicit Pilot(PilotOptions options);

  /// A client has connected; its first message must be Hello.
  void StartConnection();

  /// Replies to any bytes.
  Reply Handle(std::string_view payload);

  /// Refusal of a frame that cannot be cut out of the stream.
  Refusal Malformed(const Error& error, std::uint64_t sequence = 0);

  Counters& counters() { return counters_; }
  const ServeConfig& config() const { return options_.serve; }
  /// Null until the first Hello.
  const agent::Agent* agent() const { return agent_ ? &*agent_ : nullptr; }

 private:
  Reply Do(const Hello& hello);
  Reply Do(const SetGoal& request);
  Reply Do(const RawObservation& raw);
  Reply Do(const Reset& reset);
  Reply Do(const GetStats&) { return counters_; }

  Result<void> StartAgent(double camera_height_m);
  /// Refusal of a late frame, or of a frame without a number.
  std::optional<Refusal> OutOfOrder(const RawObservation& raw);
  Result<void> Step(Observation obs, Answer* answer);
  /// True while the robot has to find itself; the answer has the action for it.
  Result<bool> Localise(const Observation& obs, Answer* answer);
  Result<void> Arrive(const localization::LocalizeStep& found);

  PilotOptions options_;
  Counters counters_;
  std::optional<agent::Agent> agent_;
  std::optional<localization::Awakening> awakening_;  // until it is over
  Pose T_agent_world_ = Pose::Identity();             // from the client's frame to the agent's
  double camera_height_m_ = 0;                        // of agent_
  bool restore_ = false;                              // start of the next agent
  State state_;
  std::optional<Answer> last_;              // to the observation state_.last_sequence
  std::optional<CameraIntrinsics> camera_;  // of this connection; empty before Hello
  std::int64_t last_time_ns_ = 0;           // likewise; clocks may restart
};

}  // namespace crossnav::serve
