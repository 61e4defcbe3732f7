// SPDX-License-Identifier: MIT
// Visits of a house from its days and their lists of changes. Each goal is certified: what is to be
// found can be reached and observed (and confirmed, under dataset.certificate = detection), what
// is gone has no instance. World frame, metres.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/world/change/changes.h"

namespace crossnav::evaluation {

/// A house on one day; the first has no changes.
struct VisitDay {
  std::string scene_id;
  std::unique_ptr<SceneContext> context;
  world::DayChanges list;
};

inline constexpr int kLeastVisitGoals = 5, kMostVisitGoals = 10;

/// A visit a day. Goals of the first are what will change later, and what stays. Error: a day with
/// fewer than five goals.
Result<std::vector<HouseVisit>> MakeVisits(const std::vector<VisitDay>& days, std::uint64_t seed);

/// Everything in a visit's certificate that does not hold, in words; empty = proven.
std::vector<std::string> CheckVisit(const SceneContext& context, const HouseVisit& visit);

}  // namespace crossnav::evaluation
