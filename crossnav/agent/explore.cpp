// SPDX-License-Identifier: MIT
#include "crossnav/agent/explore.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/agent/closed_way.h"
#include "crossnav/agent/exploration_candidates.h"
#include "crossnav/agent/exploration_prices.h"
#include "crossnav/agent/hooks.h"
#include "crossnav/agent/last_resort.h"
#include "crossnav/agent/object_search.h"
#include "crossnav/core/check.h"
#include "crossnav/policy/flights.h"
#include "crossnav/policy/ground_frontiers.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::Candidate;
using policy::CandidateKind;

namespace {

/// Flights ahead of a search that may still win.
class FlightsAheadOf {
 public:
  FlightsAheadOf(const VoxelKey& start, double voxel_m, const ExplorationCandidates& candidates,
                 const ExplorationPrices& prices)
      : start_(start), voxel_m_(voxel_m), candidates_(candidates), prices_(prices) {}

  /// Whether one of the places that `search` will visit, at a path of `path_m` or more, may have a
  /// price below `best_m`. Calls come with rising `path_m` and falling `best_m`.
  bool MayWin(const planner::GroundSearch& search, double path_m, double best_m) {
    const auto is_open = [&](const FlightAhead& flight) {
      return !search.WasVisited(flight.place) && !candidates_.WasGiven(flight.key) &&
             LeastScore(flight, path_m) < best_m;
    };
    if (!flights_) flights_ = candidates_.FlightsAhead(is_open);
    while (!flights_->empty() && !is_open(flights_->back())) flights_->pop_back();
    return !flights_->empty();
  }

 private:
  /// No path is shorter than the straight line.
  double LeastScore(const FlightAhead& flight, double path_m) const {
    constexpr double kRounding_m = 1e-6;
    const double straight_m = geometry::VoxelDistance(start_, flight.key) * voxel_m_;
    return prices_.LeastScoreOf(flight, std::max(path_m, straight_m) - kRounding_m,
                                candidates_.has_hints());
  }

  VoxelKey start_;
  double voxel_m_;
  const ExplorationCandidates& candidates_;
  const ExplorationPrices& prices_;
  std::optional<std::vector<FlightAhead>> flights_;  // empty before the first call
};

/// Candidates in order of path cost with their prices, until none ahead can be cheaper.
std::vector<PricedCandidate> PriceCandidates(const Situation& now, const VoxelKey& start,
                                             ExplorationPrices* prices) {
  std::vector<PricedCandidate> all;
  ExplorationCandidates candidates(now);
  planner::GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  FlightsAheadOf ahead(start, now.config.map.voxel_m, candidates, *prices);
  double best_m = std::numeric_limits<double>::infinity();
  while (const auto place = search.Next()) {
    const double path_m = search.cost() * now.config.map.voxel_m;
    // A hook may prefer candidates that are far away.
    if (!now.hooks && prices->LeastScore(path_m, candidates.has_hints()) >= best_m) break;
    const bool may_win_on_level =
        now.hooks || prices->LeastScoreOnLevel(path_m, candidates.has_hints()) < best_m;
    for (ExplorationCandidate& found :
         may_win_on_level ? candidates.At(*place) : candidates.OffLevelAt(*place)) {
      all.push_back(prices->Of(std::move(found), search.PathTo(*place), path_m));
      best_m = std::min(best_m, prices->UpperBound(all.back()));
    }
    if (!may_win_on_level && !ahead.MayWin(search, path_m, best_m) &&
        !prices->MayBeRaised(all, best_m))
      break;
  }
  prices->RaiseFlightsPastFloors(&all);
  return all;
}

/// The search of a known house comes first. Where it has no view left before most was looked at,
/// ways are closed: last resorts try to open them. If none helps, the map is wrong, and frontiers
/// count as in an unknown house.
std::vector<PricedCandidate> PriceCandidatesOrSearch(const Situation& now, const VoxelKey& start,
                                                     ExplorationPrices* prices) {
  if (!now.goal.full.search) return PriceCandidates(now, start, prices);
  auto all = PriceSearch(now, start);
  if (!all.empty() || IsSearchOver(now)) return all;
  if (now.world.revision && HasOpeningResort(now.goal)) return all;
  return PriceCandidates(now, start, prices);
}

std::optional<GroundTarget> Cheapest(std::vector<PricedCandidate> all) {
  const auto best = std::min_element(all.begin(), all.end(),
                                     [](const PricedCandidate& a, const PricedCandidate& b) {
                                       return a.target.score_m < b.target.score_m;
                                     });
  if (best == all.end()) return std::nullopt;
  return std::move(best->target);
}

std::optional<GroundTarget> AskHooks(const Situation& now, std::vector<PricedCandidate> all) {
  std::vector<ExplorationOption> options;
  for (const PricedCandidate& priced : all)
    options.push_back({priced.target.candidate, priced.target.cost_m, priced.target.score_m});
  if (options.empty()) return std::nullopt;
  const std::vector<double> scores = now.hooks->ScoreExploration(now, options);
  CROSSNAV_CHECK(scores.size() == all.size(), "a hook answers with one score for each option");
  const auto least = std::min_element(scores.begin(), scores.end());
  if (!(*least < std::numeric_limits<double>::infinity())) return std::nullopt;
  return std::move(all[static_cast<std::size_t>(least - scores.begin())].target);
}

/// The goal's relevancy field where it is due for a refresh.
std::optional<policy::Relevancy> FreshRelevancy(const Situation& now) {
  const auto& explore = now.config.policy.explore;
  const FullGoal& goal = now.goal.full;
  const bool is_stale =
      goal.relevancy_step < 0 || now.world.step - goal.relevancy_step >= explore.relevancy_steps;
  if (explore.scoring != "semantic" || !is_stale) return std::nullopt;
  policy::Relevancy fresh;
  fresh.Refresh(now.world.memory, now.world.memory.Similarity(now.goal.text));
  return fresh;
}

}  // namespace

bool IsOverStairs(const Situation& now, const Vector3d& p_world) {
  if (IsOnLevel(now, p_world)) return false;
  const double voxel_m = now.config.map.voxel_m;
  const double rise_m = p_world.z() - 0.5 * voxel_m - now.world.level_m;
  // A height is known to a voxel.
  return std::abs(rise_m) - voxel_m > now.config.policy.explore.storey_m ||
         policy::EvidenceShare({p_world}, now.world.stairs, voxel_m) > 0;
}

bool IsOnLevel(const Situation& now, const Vector3d& p_world) {
  const double off_m = std::abs(p_world.z() - now.world.level_m);
  if (off_m <= now.config.policy.frontier.level_band_m + 0.5 * now.config.map.voxel_m) return true;
  return off_m <= kSplitLevel_m && policy::IsFlatAround(now.world.map, p_world);
}

ExplorationChoice ChooseExploration(const Situation& now, const VoxelKey& start) {
  ExplorationChoice choice;
  choice.relevancy = FreshRelevancy(now);
  ExplorationPrices prices(now, choice.relevancy ? *choice.relevancy : now.goal.full.relevancy);
  std::vector<PricedCandidate> all = PriceCandidatesOrSearch(now, start, &prices);
  choice.has_found_descent = prices.has_found_descent();
  for (const PricedCandidate& priced : all) choice.shown.push_back(priced.target.candidate);
  choice.target = now.hooks ? AskHooks(now, std::move(all)) : Cheapest(std::move(all));
  return choice;
}

bool IsStillOpen(const Situation& now, const Candidate& candidate) {
  VoxelKey beyond;
  switch (candidate.kind) {
    case CandidateKind::kTraversableFrontier:
    case CandidateKind::kStairFrontier:
      return std::any_of(
          candidate.standing.begin(), candidate.standing.end(), [&](const VoxelKey& key) {
            return (CenterOf(key, now.config.map.voxel_m) - candidate.p_focus_world).norm() <
                       now.config.policy.explore.same_place_m &&
                   now.world.ground.IsStanding(key) &&
                   policy::IsGroundFrontier(now.world.ground, key, &beyond);
          });
    case CandidateKind::kUninspected:
      return !now.world.coverage.IsInspected(candidate.standing.front());
    case CandidateKind::kSearchView:
      return IsViewOpen(now, candidate);
    case CandidateKind::kClosedWay:
      return IsWayClosed(now);
    default:
      return true;
  }
}

}  // namespace crossnav::agent
