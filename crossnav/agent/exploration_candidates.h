// SPDX-License-Identifier: MIT
// Candidates of exploration at the places of a search over the ground: frontiers, treads of flights
// that were not walked yet, uninspected ground, hints. World frame, metres.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "crossnav/agent/hints.h"

namespace crossnav::agent {

enum class ExplorationClass {
  kFrontier,
  kFlight,
  kUninspected,
  kHint,
  kHintFromAfar,  ///< a nearer view of it is due
};

struct ExplorationCandidate {
  ExplorationClass type = ExplorationClass::kFrontier;
  policy::Candidate candidate;
  geometry::VoxelKey place;     ///< to stand at
  bool is_on_level = true;      ///< of the exploration level
  bool is_beside_step = false;  ///< kFlight: treads are around the place
  /// kFrontier: straight line to the nearest open hint of its storey [m].
  std::optional<double> to_hint_m;
};

/// A frontier on a flight where no search was yet.
struct FlightAhead {
  std::int32_t place = -1;  ///< index among the places of the ground
  geometry::VoxelKey key;   ///< of the place
  Vector3d p_focus_world = Vector3d::Zero();
  double rise_m = 0;  ///< over the exploration level
};

/// Rise of a foot at `place` over the exploration level [m].
double RiseOf(const Situation& now, const geometry::VoxelKey& place);

/// Candidates of one search. Keeps a reference to the situation.
class ExplorationCandidates {
 public:
  explicit ExplorationCandidates(const Situation& now) : now_(now), hints_(now) {}

  /// Candidates for which `place` is the cheapest place to stand. Places come in order of cost.
  std::vector<ExplorationCandidate> At(const geometry::VoxelKey& place);
  /// Candidates of At that are on a flight or on another storey.
  std::vector<ExplorationCandidate> OffLevelAt(const geometry::VoxelKey& place);
  /// Frontiers on flights anywhere on the known ground that `may_win`, but for those that At gave.
  std::vector<FlightAhead> FlightsAhead(
      const std::function<bool(const FlightAhead&)>& may_win) const;
  /// Whether At gives a candidate of the frontier at `place` no more.
  bool WasGiven(const geometry::VoxelKey& place) const { return clustered_.contains(place); }
  bool has_hints() const { return !hints_.empty(); }

 private:
  std::optional<ExplorationCandidate> FrontierAt(const geometry::VoxelKey& place,
                                                 const geometry::VoxelKey& beyond);
  std::optional<ExplorationCandidate> UninspectedAt(const geometry::VoxelKey& place);

  const Situation& now_;
  Hints hints_;
  std::set<geometry::VoxelKey> clustered_;    // members of the frontiers so far
  std::set<geometry::VoxelKey> uninspected_;  // coarse cells so far
};

}  // namespace crossnav::agent
