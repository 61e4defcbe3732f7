// SPDX-License-Identifier: MIT
// How well a text names what a query found, on a scale that holds from map to map, and whether it
// is there at all. 0 = chance: the cosine that a tenth of the memory stays below; 1 = the vector
// itself. A query's scores rank its own places and say nothing of either.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "crossnav/memory/history_poi.h"

namespace crossnav::memory {

struct QueryMatch {
  double chance = 0;           ///< cosine [-1, 1]
  double best = 0;             ///< of the places; where there is none, of the best rows
  std::vector<double> places;  ///< of each cluster, in their order
};

/// Of what Query found for `text`; zeros for an empty memory.
QueryMatch MatchOf(const SemanticMemory& memory, std::span<const float> text,
                   std::span<const MemoryCluster> places);

enum class Verdict { kPresent, kAbsent, kUnknown };
std::string_view NameOf(Verdict verdict);

/// From which match on a text counts as present among features of `encoder` (by the name in map
/// files); nullopt where that was never measured. Of networks the card says it.
std::optional<double> PresentFrom(std::string_view encoder);

/// kUnknown where no threshold was measured.
Verdict Judge(const QueryMatch& match, std::optional<double> present_from);

}  // namespace crossnav::memory
