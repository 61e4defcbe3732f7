// SPDX-License-Identifier: MIT
#include "crossnav/recordings/image_pairs.h"

#include <cstdlib>
#include <utility>

namespace crossnav::recordings {
namespace {

constexpr std::size_t kMostHeld = 32;  // chosen: a second of 30 frames

}  // namespace

void ImagePairs::AddColour(HeldImage image) {
  colour_.push_back(std::move(image));
  if (colour_.size() > kMostHeld) colour_.pop_front();
}

std::optional<ImagePair> ImagePairs::Take(bool is_end) {
  if (depth_.empty()) return std::nullopt;
  const std::int64_t time_ns = depth_.front().time_ns;
  const bool is_decided = is_end || depth_.size() > kMostHeld ||
                          (!colour_.empty() && colour_.back().time_ns >= time_ns);
  if (!is_decided) return std::nullopt;
  ImagePair pair{std::move(depth_.front()), std::nullopt};
  depth_.pop_front();
  while (!colour_.empty() && colour_.front().time_ns < time_ns - match_ns_) colour_.pop_front();
  const HeldImage* best = nullptr;
  for (const HeldImage& colour : colour_) {
    const std::int64_t away_ns = std::abs(colour.time_ns - time_ns);
    if (away_ns > match_ns_) continue;
    if (best == nullptr || away_ns < std::abs(best->time_ns - time_ns)) best = &colour;
  }
  if (best != nullptr) pair.colour = *best;
  return pair;
}

}  // namespace crossnav::recordings
