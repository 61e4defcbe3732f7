// SPDX-License-Identifier: MIT
// Price of an exploration candidate [m]: its path, the turns before the first step, and the terms
// of its class, of the floor prior, of turning back on a flight, and of the commitment
// (docs/navigation.md, "Activities").
#pragma once

#include <vector>

#include "crossnav/agent/exploration_candidates.h"
#include "crossnav/agent/poi_targets.h"

namespace crossnav::agent {

// chosen: flat ground this near in height is the same floor
inline constexpr double kSplitLevel_m = 1.0;
// chosen: unseen area that may be a room
inline constexpr double kRoom_m2 = 4;

/// A candidate with its path and price.
struct PricedCandidate {
  GroundTarget target;
  double rise_m = 0;    ///< over the exploration level
  double spared_m = 0;  ///< discount of the commitment
  bool is_flight = false;
};

/// Prices of one search. Keeps references.
class ExplorationPrices {
 public:
  ExplorationPrices(const Situation& now, const policy::Relevancy& relevancy);

  /// `path_m`: cost of `path`.
  PricedCandidate Of(ExplorationCandidate found, std::vector<geometry::VoxelKey> path,
                     double path_m);

  /// A flight that continues past a floor with open candidates leads one storey further than that
  /// floor, however near its next tread is.
  void RaiseFlightsPastFloors(std::vector<PricedCandidate>* all) const;

  /// Whether floors that a search finds later may raise a flight that costs `best_m` at most.
  bool MayBeRaised(const std::vector<PricedCandidate>& all, double best_m) const;

  /// Lower bound of the price of a candidate of the level at the end of a path of `path_m`. The
  /// discount of a hint counts only where the goal has hints.
  double LeastScoreOnLevel(double path_m, bool has_hints) const;
  /// Lower bound for any candidate: the floor prior makes flights cheaper.
  double LeastScore(double path_m, bool has_hints) const;
  /// Lower bound for a flight at the end of a path of at least `path_m`.
  double LeastScoreOf(const FlightAhead& flight, double path_m, bool has_hints) const;
  /// Price of `priced` once RaiseFlightsPastFloors has raised it, at most.
  double UpperBound(const PricedCandidate& priced) const;
  /// A flight down from the level was priced, and none was known before.
  bool has_found_descent() const { return has_found_descent_; }

 private:
  struct Terms {
    double class_m = 0;
    double worth = 1;  ///< share of the path that counts, (0, 1]; divides the path
  };
  Terms TermsOf(const ExplorationCandidate& found, double path_m);
  double FlightPrice(double rise_m);
  /// Whether a place of that rise is on another level that was stood on.
  bool IsOnKnownLevel(double rise_m) const;
  double Doubt(const Vector3d& p_focus_world) const;
  bool HasDescent() const;
  double TurningBack(const policy::Candidate& candidate) const;
  double SettingOut(const std::vector<geometry::VoxelKey>& path) const;
  double CommitmentDiscount(const Vector3d& p_focus_world, double class_m) const;

  const Situation& now_;
  const policy::ExploreConfig& config_;
  const policy::Relevancy& relevancy_;
  double floor_prior_m_;  // positive: the goal is likelier on an upper floor; negative: below
  bool has_found_descent_ = false;
};

}  // namespace crossnav::agent
