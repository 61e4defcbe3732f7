// SPDX-License-Identifier: MIT
#include "crossnav/core/nearest.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace crossnav {
namespace {

constexpr std::size_t kMostLetters = 100;  // chosen: longer words are no typing errors

std::string_view LastPart(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

/// Number of letters to insert, remove or change; `most` + 1 where it exceeds `most`.
int EditDistance(std::string_view a, std::string_view b, int most) {
  const auto lengths = static_cast<int>(a.size()) - static_cast<int>(b.size());
  if (std::abs(lengths) > most) return most + 1;
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i) + 1;
    int least = row[0];
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
      least = std::min(least, row[j + 1]);
    }
    if (least > most) return most + 1;
  }
  return std::min(row.back(), most + 1);
}

}  // namespace

std::string DidYouMean(std::string_view word, std::span<const std::string> names) {
  if (word.size() > kMostLetters) return {};
  const std::string* best = nullptr;
  int best_distance = static_cast<int>(word.size()) / 3 + 2;
  for (const std::string& name : names) {
    int distance = EditDistance(name, word, best_distance);
    // Compares the last part of dotted keys: "voxel_m" matches "map.voxel_m".
    if (name.find('.') != std::string::npos)
      distance =
          std::min(distance, 1 + EditDistance(LastPart(name), LastPart(word), best_distance));
    if (distance < best_distance) {
      best_distance = distance;
      best = &name;
    }
  }
  return best == nullptr ? "" : "; did you mean \"" + *best + "\"?";
}

}  // namespace crossnav
