// SPDX-License-Identifier: MIT
// Cause of a failed stage in runs from pixels: the network, its masks, the memory or the motion.
// Coarser than cause.h, from the same records.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "crossnav/evaluation/records/episode_record.h"

namespace crossnav::evaluation {

inline constexpr std::array<std::string_view, 7> kPixelCauses = {
    "mistaken", "missed", "mask", "memory", "stairs unseen", "reach", "search"};

/// One of kPixelCauses; empty for a success. In this order: STOP at another thing (mistaken); STOP
/// too far from the right one, where its mask put it (mask); the last pursuit ended by a refuted
/// claim (memory); the goal was in view within the success radius and unclaimed, or nine tenths of
/// the house were seen without it (missed); no ground of the flight to it is in the map (stairs
/// unseen); the flight, or the last target, could not be reached (reach); else the budget was too
/// small (search).
std::string_view PixelCauseOf(const StageRecord& stage);

struct PixelCauseCount {
  std::string_view goal;
  std::array<int, kPixelCauses.size()> stages{};
};
/// Failed stages by goal, in the order in which goals first fail.
std::vector<PixelCauseCount> CountPixelCauses(std::span<const EpisodeRecord> episodes);

}  // namespace crossnav::evaluation
