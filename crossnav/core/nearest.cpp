// SPDX-License-Identifier: MIT
#include "crossnav/core/nearest.h"

#include <algorithm>
#include <vector>

namespace crossnav {
namespace {

constexpr std::size_t kMostLetters = 100;  // chosen: longer words are no typing errors

std::string_view LastPart(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

}  // namespace

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string DidYouMean(std::string_view word, std::span<const std::string> names) {
  if (word.size() > kMostLetters) return {};
  const std::string* best = nullptr;
  int best_distance = static_cast<int>(word.size()) / 3 + 2;
  for (const std::string& name : names) {
    int distance = EditDistance(name, word);
    // "voxel_m" for "map.voxel_m": the place is forgotten, or another.
    if (name.find('.') != std::string::npos)
      distance = std::min(distance, 1 + EditDistance(LastPart(name), LastPart(word)));
    if (distance < best_distance) {
      best_distance = distance;
      best = &name;
    }
  }
  return best == nullptr ? "" : "; did you mean \"" + *best + "\"?";
}

}  // namespace crossnav
