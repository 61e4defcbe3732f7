// SPDX-License-Identifier: MIT
// Voxel changes in few bytes: runs of equal values along z. Each run is five varints
//   zigzag(dx) zigzag(dy) zigzag(dz) length value
// where dx, dy, dz lead from the previous run's first key (from 0,0,0 at the start) to this run's
// first key, and value = state + 8 x inflated. docs/formats/replay.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_map.h"

namespace crossnav::trace {

/// `changes` sorted by key, as in StepTrace.
std::string EncodeVoxelRuns(const std::vector<geometry::StateChange>& changes);

/// Inverse of EncodeVoxelRuns; `max_count` bounds the result for damaged bytes.
Result<std::vector<geometry::StateChange>> DecodeVoxelRuns(std::string_view runs,
                                                           std::size_t max_count = 1U << 26);

}  // namespace crossnav::trace
