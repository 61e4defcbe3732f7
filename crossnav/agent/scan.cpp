// SPDX-License-Identifier: MIT
#include "crossnav/agent/scan.h"

#include <cmath>
#include <utility>

#include "crossnav/agent/shared_parts.h"

namespace crossnav::agent {

void BeginScan(StepState& now, std::deque<Action> turns) {
  EndScan(now);
  if (turns.empty()) return;
  Activity& activity = now.goal.full.activity;
  Scan scan;
  scan.turns = std::move(turns);
  std::swap(scan.suspended, PursuitOf(activity));
  activity = std::move(scan);
}

void EndScan(StepState& now) {
  Activity& activity = now.goal.full.activity;
  if (!IsScanning(activity)) return;
  Pursuit suspended;
  std::swap(suspended, PursuitOf(activity));
  activity = std::move(suspended);
}

void BeginEscape(StepState& now) {
  const auto headings = std::lround(360 / now.config.action.turn_deg);
  std::deque<Action> tries{Action::kMoveForward};
  for (long i = 1; i < headings; ++i) {
    tries.push_back(Action::kTurnLeft);
    tries.push_back(Action::kMoveForward);
  }
  BeginScan(now, std::move(tries));
  std::get<Scan>(now.goal.full.activity).p_escape_world = now.agent.p_world;
}

bool HasEscaped(const Situation& now, const Scan& scan) {
  return scan.p_escape_world && (now.agent.p_world - *scan.p_escape_world).head<2>().norm() >=
                                    now.config.policy.motion.bump_m;
}

void LookAround(StepState& now) {
  const double down_rad = DegToRad(now.config.policy.motion.travel_pitch_deg);
  BeginScan(now, FullTurn(now.agent, down_rad, now.config.action));
  now.goal.p_looked_around_world = now.agent.p_world;
  now.world.full.looked_around_m.push_back(now.agent.p_world.z());
}

bool LookUp(StepState& now) {
  constexpr double kUp_rad = DegToRad(30);  // chosen: from the camera to the agent's height, near
  const ActionConfig& action = now.config.action;
  if (action.max_pitch_deg == 0) return false;
  std::deque<Action> turns;
  AgentPose agent = now.agent;
  while (const auto pitch = policy::PitchTowards(agent, kUp_rad, action)) {
    turns.push_back(*pitch);
    agent.pitch_rad += DegToRad(*pitch == Action::kLookUp ? action.pitch_deg : -action.pitch_deg);
  }
  for (const Action turn : FullTurn(agent, kUp_rad, action)) turns.push_back(turn);
  BeginScan(now, std::move(turns));
  return true;
}

std::deque<Action> GlanceFrom(const Situation& now, const geometry::VoxelKey& start) {
  const auto heading_rad =
      policy::GlanceHeading(now.world.ground, start, now.eye, DegToRad(now.config.sensor.hfov_deg),
                            now.world.full.looked_along, now.config.policy.explore);
  if (!heading_rad) return {};
  const double off_rad = WrapAngle(*heading_rad - now.eye.yaw_rad);
  const auto count = std::lround(std::abs(off_rad) / DegToRad(now.config.action.turn_deg));
  return std::deque<Action>(static_cast<std::size_t>(count),
                            off_rad > 0 ? Action::kTurnLeft : Action::kTurnRight);
}

}  // namespace crossnav::agent
