// SPDX-License-Identifier: MIT
// Flights from stair evidence alone: what was seen as stairs and not walked yet, as records that
// grow while more of it is seen. World frame, metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/geometry/stair_flight.h"
#include "crossnav/policy/stair_evidence.h"

namespace crossnav::policy {

class FlightSurvey {
 public:
  /// Brings the flights that were not walked up to date with the evidence, and notes that the agent
  /// with its foot at `p_agent_world` sees those of the last frame. Evidence that runs on through
  /// one of `levels_m` is two flights.
  void Update(const StairEvidence& evidence, std::span<const double> levels_m,
              const Vector3d& p_agent_world, double voxel_m,
              std::vector<geometry::StairFlight>* flights);

 private:
  // When the flights were last taken from the evidence.
  std::uint64_t revision_ = 0;
  int walks_ = 0;
  std::size_t levels_ = 0;
};

}  // namespace crossnav::policy
