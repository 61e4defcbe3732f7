// SPDX-License-Identifier: MIT
// A house of axis-aligned boxes with an analytic depth camera: rooms of any size without a mesh, a
// ray tracer or a file. World frame, metres. Shared by tests and benchmarks.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/rng.h"

namespace crossnav::testing {

struct BoxRooms {
  Box3 shell;                ///< seen from inside: floor, ceiling, outer walls
  std::vector<Box3> solids;  ///< seen from outside: walls, furniture, slabs
};

inline Box3 BoxOf(double x0, double y0, double z0, double x1, double y1, double z1) {
  Box3 box;
  box.min = Vector3d(x0, y0, z0);
  box.max = Vector3d(x1, y1, z1);
  return box;
}

/// Parameters at which p + t d enters and leaves the box; enter > leave: it misses.
inline void CrossBox(const Box3& box, const Vector3d& p, const Vector3d& inverse_d, double* enter,
                     double* leave) {
  *enter = -std::numeric_limits<double>::infinity();
  *leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double t0 = (box.min[a] - p[a]) * inverse_d[a], t1 = (box.max[a] - p[a]) * inverse_d[a];
    *enter = std::max(*enter, std::min(t0, t1));
    *leave = std::min(*leave, std::max(t0, t1));
  }
}

/// Planar depth, 0 where nothing is hit.
inline DepthImage RenderDepth(const BoxRooms& rooms, const CameraIntrinsics& K, const Pose& T) {
  DepthImage depth(K.width_px, K.height_px);
  const Vector3d p = T.translation();
  for (int v = 0; v < K.height_px; ++v) {
    for (int u = 0; u < K.width_px; ++u) {
      const Vector3d d = T.linear() * BackProjectPixel(K, u, v, 1.0);
      const Vector3d inverse_d = d.cwiseInverse();
      double enter = 0, nearest = 0;
      CrossBox(rooms.shell, p, inverse_d, &enter, &nearest);
      for (const Box3& solid : rooms.solids) {
        double leave = 0;
        CrossBox(solid, p, inverse_d, &enter, &leave);
        if (enter <= leave && enter > 0) nearest = std::min(nearest, enter);
      }
      depth.At(u, v) = std::isfinite(nearest) ? static_cast<float>(nearest) : 0.0F;
    }
  }
  return depth;
}

/// One storey of `width_m` x `depth_m` with its floor at `floor_m`, 2.6 m high: inner walls with
/// doors every four metres or so, and furniture.
inline void AddStorey(Rng& rng, const Box3& plan, double floor_m, std::vector<Box3>* solids) {
  constexpr double kRoom_m = 4.1, kHeight_m = 2.6, kWall_m = 0.12, kDoor_m = 0.9;
  for (double x = plan.min.x() + kRoom_m; x < plan.max.x() - 1; x += kRoom_m) {
    for (double y = plan.min.y(); y < plan.max.y() - 0.5; y += kRoom_m) {
      const double end = std::min(y + kRoom_m, plan.max.y());
      const double door = rng.Uniform(y + 0.2, std::max(y + 0.3, end - kDoor_m - 0.2));
      solids->push_back(BoxOf(x, y, floor_m, x + kWall_m, door, floor_m + kHeight_m));
      solids->push_back(
          BoxOf(x, door, floor_m + 2.05, x + kWall_m, door + kDoor_m, floor_m + kHeight_m));
      solids->push_back(BoxOf(x, door + kDoor_m, floor_m, x + kWall_m, end, floor_m + kHeight_m));
    }
  }
  const double area = (plan.max.x() - plan.min.x()) * (plan.max.y() - plan.min.y());
  for (int i = 0; i < static_cast<int>(area / 4); ++i) {
    const double x = rng.Uniform(plan.min.x(), plan.max.x() - 1.5);
    const double y = rng.Uniform(plan.min.y(), plan.max.y() - 1.5);
    const double top = floor_m + rng.Uniform(0.3, 1.9), foot = rng.Chance(0.3) ? 0.45 : 0.0;
    solids->push_back(BoxOf(x, y, floor_m + std::min(foot, top - floor_m - 0.1),
                            x + rng.Uniform(0.2, 1.5), y + rng.Uniform(0.2, 1.5), top));
  }
}

/// A house with `storeys` floors of `width_m` x `depth_m`, 2.8 m apart.
inline BoxRooms MakeBoxHouse(std::uint64_t seed, double width_m, double depth_m, int storeys = 1) {
  constexpr double kStorey_m = 2.8, kSlab_m = 0.2;
  Rng rng(seed);
  BoxRooms rooms;
  rooms.shell = BoxOf(0, 0, 0, width_m, depth_m, storeys * kStorey_m - kSlab_m);
  for (int i = 0; i < storeys; ++i) {
    AddStorey(rng, rooms.shell, i * kStorey_m, &rooms.solids);
    if (i > 0)
      rooms.solids.push_back(BoxOf(0, 0, i * kStorey_m - kSlab_m, width_m, depth_m, i * kStorey_m));
  }
  return rooms;
}

/// A place to stand on storey `storey`, clear of furniture by `clearance_m`.
inline AgentPose RandomStand(Rng& rng, const BoxRooms& rooms, int storey,
                             double clearance_m = 0.2) {
  constexpr double kStorey_m = 2.8;
  for (;;) {
    AgentPose agent;
    agent.p_world = Vector3d(rng.Uniform(rooms.shell.min.x() + 0.3, rooms.shell.max.x() - 0.3),
                             rng.Uniform(rooms.shell.min.y() + 0.3, rooms.shell.max.y() - 0.3),
                             storey * kStorey_m);
    agent.yaw_rad = rng.Uniform(-3.14159, 3.14159);
    agent.pitch_rad = rng.Int(-1, 1) * 0.5235987755982988;
    const bool is_clear =
        std::none_of(rooms.solids.begin(), rooms.solids.end(), [&](const Box3& solid) {
          return solid.min.z() < agent.p_world.z() + 1.2 &&
                 solid.max.z() > agent.p_world.z() + 1e-6 &&
                 solid.HorizontalDistance(agent.p_world) < clearance_m;
        });
    if (is_clear) return agent;
  }
}

/// A walk of `count` poses from stand to stand: turns of 30 degrees and steps of 0.25 m, as by an
/// agent, but through walls; poses inside solids are left out.
inline std::vector<AgentPose> RandomWalk(std::uint64_t seed, const BoxRooms& rooms, int count,
                                         int storeys = 1) {
  Rng rng(seed);
  std::vector<AgentPose> walk;
  AgentPose agent = RandomStand(rng, rooms, 0);
  AgentPose target = agent;
  const auto is_inside = [&](const Vector3d& p) {
    return std::any_of(rooms.solids.begin(), rooms.solids.end(), [&](const Box3& solid) {
      return (p.array() > solid.min.array() - 0.05).all() &&
             (p.array() < solid.max.array() + 0.05).all();
    });
  };
  while (static_cast<int>(walk.size()) < count) {
    const Vector3d to = target.p_world - agent.p_world;
    if (to.norm() < 0.3 || to.z() != 0) {
      if (to.z() != 0) agent = target;
      target = RandomStand(rng, rooms, rng.Int(0, storeys - 1));
    } else {
      const double error = WrapAngle(std::atan2(to.y(), to.x()) - agent.yaw_rad);
      if (std::abs(error) > 0.27)
        agent.yaw_rad += error > 0 ? DegToRad(30) : DegToRad(-30);
      else
        agent.p_world += 0.25 * Vector3d(std::cos(agent.yaw_rad), std::sin(agent.yaw_rad), 0);
    }
    agent.pitch_rad = rng.Chance(0.2) ? DegToRad(-30) : 0.0;
    agent.p_world.x() =
        std::clamp(agent.p_world.x(), rooms.shell.min.x() + 0.2, rooms.shell.max.x() - 0.2);
    agent.p_world.y() =
        std::clamp(agent.p_world.y(), rooms.shell.min.y() + 0.2, rooms.shell.max.y() - 0.2);
    if (!is_inside(agent.p_world + Vector3d(0, 0, 0.88))) walk.push_back(agent);
  }
  return walk;
}

}  // namespace crossnav::testing
