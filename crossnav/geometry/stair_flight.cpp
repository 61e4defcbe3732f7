// SPDX-License-Identifier: MIT
#include "crossnav/geometry/stair_flight.h"

namespace crossnav::geometry {

std::string_view NameOf(TryEnding ending) {
  switch (ending) {
    case TryEnding::kNotOpened:
      return "did not open";
    case TryEnding::kNoProgress:
      return "no progress";
    case TryEnding::kUnreachable:
      return "unreachable";
    case TryEnding::kGivenUp:
      return "given up";
  }
  return "unknown";
}

Vector3d StairFlight::DirectionUp() const {
  constexpr double kReach_m = 1.5;  // chosen: five treads; where the flight turns is beyond
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p_step : steps_world) {
    Vector3d ahead = p_step - p_foot_world;
    ahead.z() = 0;
    if (ahead.norm() <= kReach_m) sum += ahead;
  }
  return sum.norm() > 0 ? Vector3d(sum.normalized()) : Vector3d::Zero();
}

}  // namespace crossnav::geometry
