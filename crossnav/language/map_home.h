// SPDX-License-Identifier: MIT
// Known home of a saved map: its graph, its records, and what its memory answers when names
// are looked for in it.
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
#include "crossnav/memory/semantic_memory.h"

namespace crossnav::language {

/// Vector of a text in the space of the memory's features.
using EncodeText = std::function<Result<std::vector<float>>(const std::string& text)>;

struct MapParts {
  const geometry::VoxelMap& map;
  const memory::SemanticMemory& memory;
  const std::vector<geometry::StairFlight>& flights;
  const std::vector<objects::ObjectRecord>& records;
  std::optional<double> present_from;  ///< of matches (memory/query_match.h); empty = not measured
};

/// Looks for each of `names`; a memory without features is not asked. Errors are the encoder's.
Result<KnownHome> HomeOf(const MapParts& parts, std::span<const std::string> names,
                         const EncodeText& encode, const memory::QueryConfig& query);

}  // namespace crossnav::language
