// SPDX-License-Identifier: MIT
// A follower that knows the navmesh: at each step it tries the twelve headings, walks the one whose
// end is nearest to the goal, and turns there by 30 degree steps. Uses the simulator's actions
// only.
#pragma once

#include <cmath>
#include <numbers>

#include "crossnav/sim/simulator.h"

namespace crossnav::world {

struct WalkResult {
  bool arrived = false;
  int actions = 0;
  double remaining_m = 0;
};

inline WalkResult WalkTo(sim::Simulator& simulator, const Vector3d& goal_world,
                         int max_actions = 800) {
  const sim::NavMesh& navmesh = simulator.navmesh();
  WalkResult result;
  double last_m = 1e9;
  while (result.actions < max_actions) {
    const AgentPose& agent = simulator.agent();
    const auto left_m = navmesh.Geodesic(agent.p_world, goal_world);
    result.remaining_m = left_m.value_or(1e9);
    if (result.remaining_m < 0.3) {
      result.arrived = std::abs(agent.p_world.z() - goal_world.z()) < 0.3;
      return result;
    }
    int best_turn = 0;
    double best_m = 1e9;
    for (int turn = -5; turn <= 6; ++turn) {
      const double yaw = agent.yaw_rad + turn * std::numbers::pi / 6;
      const Vector3d ahead = agent.p_world + 0.25 * Vector3d(std::cos(yaw), std::sin(yaw), 0);
      const Vector3d end = navmesh.WalkStraight(agent.p_world, ahead);
      const double m = navmesh.Geodesic(end, goal_world).value_or(1e9) + 1e-3 * std::abs(turn);
      if (m < best_m) {
        best_m = m;
        best_turn = turn;
      }
    }
    if (best_m > last_m - 1e-4 && best_m > result.remaining_m - 1e-3) return result;  // stuck
    last_m = best_m;
    for (int i = 0; i < std::abs(best_turn); ++i, ++result.actions) {
      simulator.Step(best_turn > 0 ? Action::kTurnLeft : Action::kTurnRight);
    }
    simulator.Step(Action::kMoveForward);
    ++result.actions;
  }
  return result;
}

}  // namespace crossnav::world
