// SPDX-License-Identifier: MIT
#include "crossnav/agent/exploration_prices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/policy/whereabouts.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::Candidate;

namespace {

constexpr std::size_t kHeading = 5;  // chosen: places of a path that give its direction
constexpr double kRoom_m2 = 4;       // chosen: unseen area that may be a room
constexpr double kFromAfar_m = 4;    // chosen: the path around a table to a nearer view

bool IsOfKind(const Pursuit& pursuit, policy::CandidateKind kind) {
  return IsExploring(pursuit) && PursuedIn(pursuit)->target.kind == kind;
}

}  // namespace

ExplorationPrices::ExplorationPrices(const Situation& now, const policy::Relevancy& relevancy)
    : now_(now),
      config_(now.config.policy.explore),
      relevancy_(relevancy),
      floor_prior_m_(config_.floor_prior_m_per_bit * policy::UpperStoreyBits(now.goal.goal)) {}

PricedCandidate ExplorationPrices::Of(ExplorationCandidate found, std::vector<VoxelKey> path,
                                      double path_m) {
  const Terms terms = TermsOf(found, path_m);
  PricedCandidate priced;
  priced.rise_m = RiseOf(now_, found.place);
  priced.is_flight = found.type == ExplorationClass::kFlight && found.is_beside_step;
  GroundTarget& target = priced.target;
  target.path = std::move(path);
  target.cost_m = path_m + SettingOut(target.path);
  target.score_m = (target.cost_m + config_.start_m) / terms.worth + terms.class_m +
                   TurningBack(found.candidate);
  if (IsOfKind(PursuitOf(now_.goal.full.activity), found.candidate.kind))
    priced.spared_m = CommitmentDiscount(found.candidate.p_focus_world, terms.class_m);
  target.score_m -= priced.spared_m;
  target.candidate = std::move(found.candidate);
  target.candidate.score = -target.score_m;
  return priced;
}

ExplorationPrices::Terms ExplorationPrices::TermsOf(const ExplorationCandidate& found,
                                                    double path_m) {
  const double level_m = found.is_on_level ? 0 : config_.other_floor_penalty_m;
  switch (found.type) {
    case ExplorationClass::kFlight:
      return {FlightPrice(RiseOf(now_, found.place)) + Doubt(found.candidate.p_focus_world)};
    case ExplorationClass::kUninspected:
      return {config_.uninspected_m + level_m};
    case ExplorationClass::kHint:
      return {config_.hint_bonus_m + level_m};
    case ExplorationClass::kHintFromAfar:
      return {config_.hint_bonus_m + kFromAfar_m + level_m};
    case ExplorationClass::kFrontier:
      break;
  }
  const bool is_small = found.candidate.size < config_.min_cluster;
  Terms terms{level_m + (is_small ? config_.small_frontier_penalty_m : 0) +
                  Doubt(found.candidate.p_focus_world),
              policy::FrontierWorth(now_.world.ground, found.place, relevancy_, config_)};
  // A frontier on the straight line to a hint may be priced by that line.
  const double rest_m = path_m + config_.start_m;
  if (found.to_hint_m &&
      *found.to_hint_m + config_.hint_bonus_m < terms.class_m + rest_m * (1 / terms.worth - 1))
    terms = {*found.to_hint_m + config_.hint_bonus_m, 1};
  return terms;
}

/// The edge of a world, a window front or a hedge is one long frontier that opens nowhere.
double ExplorationPrices::Doubt(const Vector3d& p_focus_world) const {
  const auto& attempts = now_.goal.full.attempts;
  const auto closed = std::count_if(attempts.begin(), attempts.end(), [&](const Attempt& attempt) {
    return policy::IsFrontier(attempt.kind) &&
           (attempt.ending == Ending::kNotOpened || attempt.ending == Ending::kNoProgress) &&
           (attempt.p_focus_world - p_focus_world).norm() < config_.doubt_range_m;
  });
  return config_.doubt_m * static_cast<double>(closed);
}

/// Price of a flight to where the goal is likelier or less likely to be. The floor prior applies
/// upward only from the lowest known floor, and not to what was stood on: seen from a landing, the
/// floor below would be likelier than it is to those who stand on it, and the agent goes to and
/// fro.
double ExplorationPrices::FlightPrice(double rise_m) {
  if (std::abs(rise_m) < now_.config.map.voxel_m) return 0;  // first edge: direction not seen yet
  if (IsOnKnownLevel(rise_m)) return config_.other_floor_penalty_m;
  if (rise_m < 0) {
    has_found_descent_ = has_found_descent_ || !HasDescent();
    return config_.other_floor_penalty_m + floor_prior_m_;
  }
  return config_.other_floor_penalty_m - (HasDescent() ? 0 : floor_prior_m_);
}

bool ExplorationPrices::IsOnKnownLevel(double rise_m) const {
  const World& world = now_.world;
  const double band_m = now_.config.policy.frontier.level_band_m, z_m = world.level_m + rise_m;
  return std::any_of(world.levels_m.begin(), world.levels_m.end(), [&](double level_m) {
    return std::abs(level_m - z_m) < band_m && std::abs(level_m - world.level_m) >= band_m;
  });
}

bool ExplorationPrices::HasDescent() const {
  const World& world = now_.world;
  const auto& with_descent = world.full.levels_with_descent_m;
  return has_found_descent_ ||
         std::any_of(world.levels_m.begin(), world.levels_m.end(),
                     [&](double m) { return m < world.level_m - config_.storey_m; }) ||
         std::any_of(with_descent.begin(), with_descent.end(),
                     [&](double m) { return std::abs(m - world.level_m) < kSplitLevel_m; });
}

/// On a flight, candidates in the direction that the agent came from cost more.
double ExplorationPrices::TurningBack(const Candidate& candidate) const {
  const Pursuit& pursuit = PursuitOf(now_.goal.full.activity);
  if (!IsExploring(pursuit) || now_.world.full.flat_frames > 0) return 0;
  const double ahead_m = PursuedIn(pursuit)->target.p_focus_world.z() - now_.world.level_m;
  if (std::abs(ahead_m) < now_.config.policy.frontier.level_band_m) return 0;
  const double there_m = candidate.p_focus_world.z() - now_.agent.p_world.z();
  return ahead_m * there_m < 0 && std::abs(there_m) > 0.3 ? config_.turn_back_m : 0;
}

/// Turns before the first step of a path, as metres that could be walked instead.
double ExplorationPrices::SettingOut(const std::vector<VoxelKey>& path) const {
  if (path.size() < 2) return 0;
  const VoxelKey ahead = path[std::min(kHeading, path.size() - 1)] - path.front();
  const double off_rad = std::abs(WrapAngle(std::atan2(ahead.y, ahead.x) - now_.agent.yaw_rad));
  return std::round(off_rad / DegToRad(now_.config.action.turn_deg)) * now_.config.action.forward_m;
}

/// Hysteresis: the current target does not pay its class penalty again.
double ExplorationPrices::CommitmentDiscount(const Vector3d& p_focus_world, double class_m) const {
  const Pursuit& pursuit = PursuitOf(now_.goal.full.activity);
  if (!IsExploring(pursuit)) return 0;
  const Vector3d& p_current_world = PursuedIn(pursuit)->target.p_focus_world;
  if ((p_current_world - p_focus_world).norm() >= 2 * config_.same_place_m) return 0;
  return config_.commit_m + std::max(0.0, class_m);
}

void ExplorationPrices::RaiseFlightsPastFloors(std::vector<PricedCandidate>* all) const {
  for (PricedCandidate& flight : *all) {
    if (!flight.is_flight) continue;
    const bool is_past = std::any_of(all->begin(), all->end(), [&](const PricedCandidate& floor) {
      return !floor.is_flight && std::abs(floor.rise_m) >= config_.storey_m &&
             floor.rise_m * flight.rise_m > 0 &&
             std::abs(floor.rise_m) < std::abs(flight.rise_m) - now_.config.map.voxel_m;
    });
    if (!is_past) continue;
    flight.target.score_m += config_.other_floor_penalty_m + flight.spared_m;
    flight.target.candidate.score = -flight.target.score_m;
  }
}

bool ExplorationPrices::MayBeRaised(const std::vector<PricedCandidate>& all, double best_m) const {
  return std::any_of(all.begin(), all.end(), [&](const PricedCandidate& priced) {
    return priced.is_flight && priced.target.score_m <= best_m &&
           std::abs(priced.rise_m) > config_.storey_m + now_.config.map.voxel_m;
  });
}

double ExplorationPrices::LeastScoreOnLevel(double path_m, bool has_hints) const {
  const double hint_m = has_hints ? std::min(0.0, config_.hint_bonus_m) : 0;
  const bool is_committed = IsExploring(PursuitOf(now_.goal.full.activity));
  return path_m + config_.start_m + hint_m - (is_committed ? config_.commit_m : 0);
}

double ExplorationPrices::LeastScore(double path_m, bool has_hints) const {
  const double down_m = config_.other_floor_penalty_m + floor_prior_m_;
  const double up_m = config_.other_floor_penalty_m - (HasDescent() ? 0 : floor_prior_m_);
  return LeastScoreOnLevel(path_m, has_hints) + std::min({0.0, down_m, up_m});
}

double ExplorationPrices::LeastScoreOf(const FlightAhead& flight, double path_m,
                                       bool has_hints) const {
  const bool is_level = std::abs(flight.rise_m) < now_.config.map.voxel_m;
  if (IsOnKnownLevel(flight.rise_m)) {
    const double class_m = config_.other_floor_penalty_m + Doubt(flight.p_focus_world);
    return path_m + config_.start_m + class_m - CommitmentDiscount(flight.p_focus_world, class_m);
  }
  // The first flight down changes the prices of flights up, even if another candidate wins.
  if (!is_level && flight.rise_m < 0 && !HasDescent()) return LeastScore(path_m, has_hints);
  const double up_m = HasDescent() ? 0 : std::max(0.0, floor_prior_m_);
  const double prior_m = flight.rise_m < 0 ? floor_prior_m_ : -up_m;
  const double class_m =
      (is_level ? 0 : config_.other_floor_penalty_m + prior_m) + Doubt(flight.p_focus_world);
  return path_m + config_.start_m + class_m - CommitmentDiscount(flight.p_focus_world, class_m);
}

double ExplorationPrices::UpperBound(const PricedCandidate& priced) const {
  return priced.target.score_m +
         (priced.is_flight ? config_.other_floor_penalty_m + priced.spared_m : 0);
}

}  // namespace crossnav::agent
