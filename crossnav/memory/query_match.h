// SPDX-License-Identifier: MIT
// Match of a query: how well a text names the places found, on a scale comparable between maps, and
// whether the object is present at all. 0 = chance: the tenth percentile of the memory's
// cosines; 1 = the vector itself. Scores of a query only rank its own places.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "crossnav/memory/history_poi.h"

namespace crossnav::memory {

struct QueryMatch {
  double chance = 0;           ///< cosine [-1, 1]
  double best = 0;             ///< of the places; without places, of the best rows
  std::vector<double> places;  ///< of each cluster, in their order
};

/// Match of the clusters that Query found for `text`; zeros for an empty memory.
QueryMatch MatchOf(const SemanticMemory& memory, std::span<const float> text,
                   std::span<const MemoryCluster> places);

enum class Verdict { kPresent, kAbsent, kUnknown };
std::string_view NameOf(Verdict verdict);

/// Matches that decide; a match between both decides nothing.
struct MatchThresholds {
  double absent_below = 0, present_from = 0;
};

/// Thresholds for features of `encoder` (by the name in map files); nullopt where they were never
/// measured. Of networks the card has them.
std::optional<MatchThresholds> ThresholdsOf(std::string_view encoder);

/// kUnknown between the thresholds, and where none were measured.
Verdict Judge(const QueryMatch& match, const std::optional<MatchThresholds>& thresholds);

}  // namespace crossnav::memory
