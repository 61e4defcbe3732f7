// SPDX-License-Identifier: MIT
#include "crossnav/agent/progress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/agent/scan.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/policy/flights.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::agent {

namespace {

constexpr int kBumps = 6;        // chosen: without progress, before a pursuit is given up
constexpr int kBumpsInVain = 2;  // chosen: the same, at marked places

}  // namespace

void NoteBump(StepState& now) {
  if (!now.world.full.before_forward) return;
  const AgentPose before = *std::exchange(now.world.full.before_forward, std::nullopt);
  const Vector3d moved = now.agent.p_world - before.p_world;
  if (moved.head<2>().norm() >= now.config.policy.motion.bump_m) return;
  // The missing part of the step points at the obstacle: for a body that slides along a wall, the
  // wall is beside it, and the ground ahead is free.
  Vector3d missing =
      now.config.action.forward_m * Vector3d(std::cos(before.yaw_rad), std::sin(before.yaw_rad), 0);
  missing -= Vector3d(moved.x(), moved.y(), 0);
  const Vector3d ahead = missing.normalized(), left(-ahead.y(), ahead.x(), 0);
  const double voxel_m = now.config.map.voxel_m;
  const Vector3d p_contact =
      now.agent.p_world + (now.config.map.agent_radius_m + 0.5 * voxel_m) * ahead;
  // A bump at a marked place means that the obstacle is wider.
  bool is_new = false;
  for (double aside_m = 0; aside_m <= 2 * voxel_m && !is_new; aside_m += voxel_m) {
    is_new = now.world.ground.Block(p_contact + aside_m * left);
    is_new = now.world.ground.Block(p_contact - aside_m * left) || is_new;
  }
  if (Pursued* pursued = PursuedIn(PursuitOf(now.goal.full.activity))) {
    pursued->route.motion.clear();
    // Without new knowledge the next step would be the same.
    pursued->route.idle_steps +=
        now.config.policy.explore.progress_steps / (is_new ? kBumps : kBumpsInVain);
  }
  now.goal.events.push_back("bump");
}

void NoteLevel(StepState& now) {
  World& world = now.world;
  const double z_m = now.agent.p_world.z();
  if (!world.has_level) {
    EnterLevel(world, z_m);
    LookAround(now);
    return;
  }
  auto& path = world.path_off_level_world;
  if (std::abs(z_m - world.level_m) < now.config.policy.frontier.level_band_m) {
    world.full.flat_frames = 1;
    path.assign(1, now.agent.p_world);
    return;
  }
  NoteOffLevel(world, now.agent.p_world, now.config.map.voxel_m);
  const bool is_flat = policy::IsFlatAround(world.map, now.agent.p_world);
  world.full.flat_frames = is_flat ? world.full.flat_frames + 1 : 0;
  if (world.full.flat_frames < now.config.policy.stair.landing_frames) return;
  now.goal.events.push_back(z_m > world.level_m ? "new level above" : "new level below");
  if (path.size() > 1) {
    const auto& flight =
        policy::NoteWalk(path, world.stairs, now.config.map.voxel_m, &world.flights);
    world.map.MarkStair(policy::EvidenceOn(flight, world.stairs, now.config.map.voxel_m),
                        geometry::StairMark::kStair);
    const int walks = flight.walked_up + flight.walked_down;
    now.goal.events.push_back(walks == 1 ? "a flight is known" : "a known flight was walked again");
  }
  path.assign(1, now.agent.p_world);
  EnterLevel(world, z_m);
  const bool is_known = std::any_of(
      world.full.looked_around_m.begin(), world.full.looked_around_m.end(), [&](double looked_m) {
        return std::abs(z_m - looked_m) < now.config.policy.explore.storey_m;
      });
  if (!is_known) LookAround(now);
}

}  // namespace crossnav::agent
