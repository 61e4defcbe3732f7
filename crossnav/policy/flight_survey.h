// SPDX-License-Identifier: MIT
// Flights from stair evidence alone: seen and not walked yet, as records that grow with the
// evidence. World frame, metres.
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
  /// Updates the unwalked flights from the evidence, and notes that the agent with its foot at
  /// `p_agent_world` sees the flights of the last frame. Evidence that continues through one of
  /// `levels_m` is two flights.
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
