// SPDX-License-Identifier: MIT
// Messages between client and server, as plain structs. proto/live.proto defines their wire format
// and the meaning of each field; only messages.cpp uses it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/camera.h"
#include "crossnav/core/result.h"
#include "crossnav/serve/command.h"

namespace crossnav::serve {

inline constexpr std::uint32_t kProtocol = 1;

struct Hello {
  std::uint32_t protocol = 0;
  CameraIntrinsics camera;  ///< unchecked
  double camera_height_m = 0;
};

struct SetGoal {
  std::string goal;
};

/// A received observation: sizes and numbers are not checked yet.
struct RawObservation {
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  std::string rgb, depth;
  bool is_depth_mm = false;  ///< uint16 [mm] instead of float32 [m]
  std::vector<double> T_world_camera;
  bool has_collided = false;
  std::optional<CameraIntrinsics> rgb_camera;
  std::vector<double> T_camera_rgb, T_base_camera;  ///< empty if absent
};

struct Reset {
  bool restore = false;
};

struct GetStats {};

using Request = std::variant<Hello, SetGoal, RawObservation, Reset, GetStats>;

enum class Phase { kNoGoal, kSearching, kClaimed, kExplored };

/// Whether the agent knows where in its map it is; given = the client's poses are in the map's
/// frame.
enum class PoseState { kGiven, kLocalising, kKnown, kUnknown };

struct State {
  Phase phase = Phase::kNoGoal;
  std::string goal;
  std::uint32_t goals = 0;
  std::uint64_t steps = 0;
  std::uint64_t last_sequence = 0;
  PoseState pose = PoseState::kGiven;
  std::optional<Pose> T_map_world{};  ///< once known
};

struct Welcome {
  std::string version, perception;
  std::vector<std::string> goals;
  ActionConfig action;
  double period_s = 0, watchdog_s = 0;
  State state;
};

struct Answer {
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  std::optional<Action> action;  ///< empty: stay
  Command command;
  State state;
  std::string mode, reason;
  std::optional<Vector3d> p_claimed_world;
};

/// Counts since the server's start; proto/live.proto defines them.
struct Counters {
  std::uint64_t connections = 0, refused = 0, replaced = 0;
  std::uint64_t observations = 0, answered = 0, repeated = 0, late = 0, dropped = 0;
  std::uint64_t malformed = 0, failed = 0, collisions = 0, goals = 0, resets = 0, stops = 0;
};

/// Calls visit(name, count) for each counter.
template <class V, class C>
requires std::is_same_v<std::remove_const_t<C>, Counters>
void Visit(V&& visit, C& c) {
  visit("connections", c.connections);
  visit("refused", c.refused);
  visit("replaced", c.replaced);
  visit("observations", c.observations);
  visit("answered", c.answered);
  visit("repeated", c.repeated);
  visit("late", c.late);
  visit("dropped", c.dropped);
  visit("malformed", c.malformed);
  visit("failed", c.failed);
  visit("collisions", c.collisions);
  visit("goals", c.goals);
  visit("resets", c.resets);
  visit("stops", c.stops);
}

enum class Fault { kMalformed = 1, kLate, kBusy, kReplaced, kRefused, kFailed };

struct Refusal {
  Fault fault = Fault::kMalformed;
  std::string text;
  std::uint64_t sequence = 0;
};

struct Stop {
  double silent_s = 0;
};

using Reply = std::variant<Welcome, State, Answer, Counters, Refusal, Stop>;

/// Error: bytes that are no Request of this protocol.
Result<Request> ParseRequest(std::string_view bytes);

std::string BytesOf(const Reply& reply);

}  // namespace crossnav::serve
