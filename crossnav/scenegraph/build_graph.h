// SPDX-License-Identifier: MIT
// Scene graph of a saved map: floors and rooms from its geometry alone, objects from its memory.
#pragma once

#include <span>

#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/objects/object_record.h"
#include "crossnav/scenegraph/scene_graph.h"

namespace crossnav::scenegraph {

/// Floors, rooms, passages and stairs; no objects yet.
SceneGraph BuildGraph(const geometry::VoxelMap& map, const memory::SemanticMemory& memory,
                      const std::vector<geometry::StairFlight>& flights);

/// Floor of a point: the highest floor with its ground at most 0.5 m above the point; empty below
/// all.
std::optional<int> FloorAt(const SceneGraph& graph, const Vector3d& p_world);

/// Room of a point on a floor, within half a metre; empty without a room.
std::optional<int> RoomAt(const SceneGraph& graph, int floor, const Vector3d& p_world);

/// Sets floor and room of every record by the graph.
void LocateRecords(const SceneGraph& graph, std::vector<objects::ObjectRecord>& records);

/// Adds records with a confidence of `least` or more, from `least_views` or more, as objects.
void AddRecords(SceneGraph& graph, std::span<const objects::ObjectRecord> records,
                double least = 0.5, int least_views = 1);

/// Gives the object its id, floor and room, and appends it.
void AddObject(SceneGraph& graph, GraphObject object);

/// Computes the relations of the objects of each floor. Replaces `graph.relations`.
void RelateObjects(SceneGraph& graph);

}  // namespace crossnav::scenegraph
