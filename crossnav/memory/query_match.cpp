// SPDX-License-Identifier: MIT
#include "crossnav/memory/query_match.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace crossnav::memory {
namespace {

constexpr std::size_t kBestRows = 20;  // chosen: four clusters of the minimum size
constexpr std::size_t kChanceShare =
    10;  // chosen: a tenth; walls, a valid query, are a larger share

// Measured on development houses by benchmarks/query_calibration.cpp (docs/cli.md, "Is it there?").
constexpr std::array<std::pair<std::string_view, double>, 2> kPresentFrom = {
    {{"ground-truth", 0.48}, {"ground-truth-clip", 0.58}}};

double OnScale(double cosine, double chance) {
  return chance < 1 ? (cosine - chance) / (1 - chance) : 0;
}

/// Mean of the highest few.
double PeakOf(std::vector<float>& values) {
  const std::size_t count = std::min(values.size(), kBestRows);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(values.begin(), end, values.end(), std::greater<>());
  return std::accumulate(values.begin(), end, 0.0) / static_cast<double>(count);
}

}  // namespace

QueryMatch MatchOf(const SemanticMemory& memory, std::span<const float> text,
                   std::span<const MemoryCluster> places) {
  QueryMatch match;
  if (memory.Size() == 0) return match;
  std::vector<float> cosine = memory.Similarity(text);
  const auto low = cosine.begin() + static_cast<std::ptrdiff_t>(cosine.size() / kChanceShare);
  std::nth_element(cosine.begin(), low, cosine.end());
  match.chance = *low;
  for (const MemoryCluster& place : places) {
    match.places.push_back(OnScale(place.similarity, match.chance));
  }
  match.best = match.places.empty() ? OnScale(PeakOf(cosine), match.chance)
                                    : *std::max_element(match.places.begin(), match.places.end());
  return match;
}

std::string_view NameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPresent:
      return "present";
    case Verdict::kAbsent:
      return "absent";
    case Verdict::kUnknown:
      return "unknown";
  }
  return {};
}

std::optional<MatchThresholds> ThresholdsOf(std::string_view encoder) {
  for (const auto& [name, from] : kPresentFrom) {
    if (name == encoder) return MatchThresholds{from, from};
  }
  return std::nullopt;
}

Verdict Judge(const QueryMatch& match, const std::optional<MatchThresholds>& thresholds) {
  if (!thresholds) return Verdict::kUnknown;
  if (match.best >= thresholds->present_from) return Verdict::kPresent;
  return match.best < thresholds->absent_below ? Verdict::kAbsent : Verdict::kUnknown;
}

}  // namespace crossnav::memory
