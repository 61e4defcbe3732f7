// SPDX-License-Identifier: MIT
// Known home of a saved map: its graph, its records, and places where its memory matches a name.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/language/known_home.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::language {

/// Vector of a text in the space of the memory's features.
using EncodeText = std::function<Result<std::vector<float>>(const std::string& text)>;

struct MapParts {
  const geometry::VoxelMap& map;
  const memory::SemanticMemory& memory;
  const std::vector<geometry::StairFlight>& flights;
  const std::vector<objects::ObjectRecord>& records;
  std::optional<memory::MatchThresholds> thresholds;  ///< empty = not measured
};

/// Queries the memory for each of `names`; skips a memory without features. Errors: of the encoder.
Result<KnownHome> HomeOf(const MapParts& parts, std::span<const std::string> names,
                         const EncodeText& encode, const memory::QueryConfig& query);

}  // namespace crossnav::language
