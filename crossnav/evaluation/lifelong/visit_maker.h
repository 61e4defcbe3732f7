// SPDX-License-Identifier: MIT
// Makes the visits of a house from its days and their lists of changes. Certificates: a present
// goal can be reached and observed (and confirmed, under dataset.certificate = detection), an
// absent goal has no instance. World frame, metres.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/world/change/changes.h"

namespace crossnav::evaluation {

/// A house on one day; the first day has no changes.
struct VisitDay {
  std::string scene_id;
  std::unique_ptr<SceneContext> context;
  world::DayChanges list;
};

inline constexpr int kLeastVisitGoals = 5, kMostVisitGoals = 10;

/// One visit per day. Goals of the first day are objects that change later, and objects that stay.
/// Error: a day with fewer than five goals.
Result<std::vector<HouseVisit>> MakeVisits(const std::vector<VisitDay>& days, std::uint64_t seed);

/// Violations of a visit's certificate, in words; empty = proven.
std::vector<std::string> CheckVisit(const SceneContext& context, const HouseVisit& visit);

}  // namespace crossnav::evaluation
