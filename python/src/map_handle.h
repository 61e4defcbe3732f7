// SPDX-License-Identifier: MIT
// Maps and memories in Python: its own, writable, or an agent's, read-only. Agents get copies, so
// that no Python object is left empty.
#pragma once

#include <nanobind/stl/unique_ptr.h>
#include <memory>

#include "common.h"
#include "crossnav/agent/agent.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::python {

struct MapHandle {
  explicit MapHandle(std::unique_ptr<geometry::VoxelMap> own) : owned(std::move(own)) {
    map = owned.get();
  }
  explicit MapHandle(const agent::Agent& a) : map(&a.map()), agent(&a) {}

  /// Raises if the map is an agent's.
  geometry::VoxelMap& Writable();

  std::vector<geometry::StairFlight> Flights() const { return agent ? agent->flights() : flights; }
  std::vector<geometry::SeenStair> SeenStairs() const {
    return agent ? agent->seen_stairs() : seen_stairs;
  }

  const geometry::VoxelMap* map;
  const agent::Agent* agent = nullptr;  ///< owner, if the map is an agent's
  std::unique_ptr<geometry::VoxelMap> owned;
  // Flights of the file that it was loaded from.
  std::vector<geometry::StairFlight> flights;
  std::vector<geometry::SeenStair> seen_stairs;
  // End voxels of the last frame, for lifting features.
  const geometry::EndVoxels* ends = nullptr;
  DepthImage depth_m;
  CameraIntrinsics camera;
  Pose T_world_camera = Pose::Identity();
  std::atomic<bool> in_use{false};
};

struct MemoryHandle {
  MemoryHandle(std::unique_ptr<memory::SemanticMemory> own, memory::QueryConfig config)
      : owned(std::move(own)), query(std::move(config)) {
    memory = owned.get();
  }
  MemoryHandle(const memory::SemanticMemory& of_agent, memory::QueryConfig config)
      : memory(&of_agent), query(std::move(config)) {}

  const memory::SemanticMemory* memory;
  std::unique_ptr<memory::SemanticMemory> owned;
  memory::QueryConfig query;
  std::atomic<bool> in_use{false};
};

/// Raises if the vector differs in length from the memory's rows or is zero.
void CheckText(const memory::SemanticMemory& memory, std::span<const float> text);

geometry::VoxelMap CopyOf(const geometry::VoxelMap& map);
memory::SemanticMemory CopyOf(const memory::SemanticMemory& memory);

}  // namespace crossnav::python
