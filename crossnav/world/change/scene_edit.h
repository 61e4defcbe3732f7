// SPDX-License-Identifier: MIT
// Edits of a loaded scene: move, copy and remove instances, add boards. World frame, metres. Call
// Settle() after the last edit; it computes boxes and hashes.
#pragma once

#include <functional>
#include <string>

#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Turns an instance about the vertical through `pivot_world` and shifts it.
struct Shift {
  Vector3d pivot_world = Vector3d::Zero();
  double yaw_rad = 0;
  Vector3d by_world = Vector3d::Zero();

  Vector3d Of(const Vector3d& p_world) const;
};

/// Moves the triangles of `id`; shared vertices stay for the other instances.
void MoveInstance(sim::Scene& scene, int id, const Shift& shift);

/// Adds a copy of `id` at another place and returns the copy's id.
int CopyInstance(sim::Scene& scene, int id, const Shift& shift);

/// Removes its triangles and its name.
void RemoveInstance(sim::Scene& scene, int id);

/// Removes the triangles of `id` whose centre fulfils `is_out`.
void RemoveTriangles(sim::Scene& scene, int id,
                     const std::function<bool(const Vector3d& centre_world)>& is_out);

/// Vertical board on the ground.
struct Board {
  Vector3d centre_world = Vector3d::Zero();  ///< of its lower edge
  double yaw_rad = 0;                        ///< of its long side; 0 = world x
  double length_m = 1, height_m = 1, thickness_m = 0.04;
};
/// Adds the board to instance `id`, which must exist, with a new material for its colour.
void AddBoard(sim::Scene& scene, int id, const Board& board, Rgb8 colour);

/// New instance without triangles; returns its id, one above the highest.
int AddInstance(sim::Scene& scene, const std::string& name, int region);

/// Drops vertices that no triangle uses and works out boxes and hash.
void Settle(sim::Scene& scene);

}  // namespace crossnav::world
