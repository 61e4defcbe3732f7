// SPDX-License-Identifier: MIT
// Voxels as coloured points in a binary PLY file, for any point-cloud viewer: by state, or by
// similarity to a query. World frame, metres, voxel centres.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::store {

struct PlyPoint {
  Vector3f p_world = Vector3f::Zero();
  Rgb8 colour;
  float value = 0;  ///< the state's number, or the similarity
};

/// One point per observed voxel, sorted by key; `surfaces_only` leaves out the air.
std::vector<PlyPoint> StatePoints(const geometry::VoxelMap& map, bool surfaces_only);

/// One point per feature row. `field` is memory.Similarity(text) or RelevancyField; colours run
/// from dark blue at its lowest to yellow at its highest value.
std::vector<PlyPoint> FieldPoints(const memory::SemanticMemory& memory,
                                  std::span<const float> field);

/// Writes the whole file or nothing.
Result<void> WritePly(const std::filesystem::path& path, std::span<const PlyPoint> points);

/// Colour of a state, common to all exports.
Rgb8 ColourOf(geometry::VoxelState state);

}  // namespace crossnav::store
