// SPDX-License-Identifier: MIT
// A follower with knowledge of the navmesh: at each step it tries the twelve headings, selects the
// heading with the end nearest to the goal, and turns there by 30 degree steps. Uses the
// simulator's actions only.
#pragma once

#include <cmath>
#include <numbers>

#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::world {

struct WalkResult {
  bool arrived = false;
  int actions = 0;
  double remaining_m = 0;
};

inline constexpr double kTurn_rad = std::numbers::pi / 6;

/// Where a forward step from `p_world` ends.
inline Vector3d Ahead(const sim::NavMesh& navmesh, const Vector3d& p_world, double yaw_rad) {
  const Vector3d step(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  return navmesh.WalkStraight(p_world, p_world + 0.25 * step);
}

inline WalkResult WalkTo(sim::Simulator& simulator, const Vector3d& goal_world,
                         int max_actions = 800) {
  const sim::NavMesh& navmesh = simulator.navmesh();
  WalkResult result;
  while (result.actions < max_actions) {
    const AgentPose& agent = simulator.agent();
    const auto left_m = navmesh.Geodesic(agent.p_world, goal_world);
    result.remaining_m = left_m.value_or(1e9);
    if (result.remaining_m < 0.3) {
      result.arrived = std::abs(agent.p_world.z() - goal_world.z()) < 0.3;
      return result;
    }
    // Two steps ahead: one step alone sticks at the ends of railings.
    int best_turn = 0;
    double best_m = 1e9;
    for (int turn = -5; turn <= 6; ++turn) {
      const Vector3d end = Ahead(navmesh, agent.p_world, agent.yaw_rad + turn * kTurn_rad);
      const double moved_m = (end - agent.p_world).norm();
      if (moved_m < 0.02) continue;
      double m = navmesh.Geodesic(end, goal_world).value_or(1e9);
      for (int next = 0; next < 12; ++next) {
        const Vector3d then = Ahead(navmesh, end, agent.yaw_rad + next * kTurn_rad);
        m = std::min(m, navmesh.Geodesic(then, goal_world).value_or(1e9) + 1e-3);
      }
      m += 1e-3 * std::abs(turn);
      if (m < best_m) {
        best_m = m;
        best_turn = turn;
      }
    }
    if (best_m > result.remaining_m - 1e-3) return result;  // stuck
    for (int i = 0; i < std::abs(best_turn); ++i, ++result.actions) {
      simulator.Step(best_turn > 0 ? Action::kTurnLeft : Action::kTurnRight);
    }
    simulator.Step(Action::kMoveForward);
    ++result.actions;
  }
  return result;
}

}  // namespace crossnav::world
