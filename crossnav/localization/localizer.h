// SPDX-License-Identifier: MIT
// "Awake and lost": finds the odometry's frame in a saved map, one observation in, one action out.
// The robot looks around; if several hypotheses remain, it walks to a place where their predictions
// differ. "Unknown" is a possible answer. Poses of the odometry must be right relative to each
// other. Deterministic; not thread-safe.
#pragma once

#include <memory>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/localization/belief.h"

namespace crossnav::localization {

class Localizer {
 private:
  struct Impl;

 public:
  /// Keeps a reference to `map`.
  Localizer(const PlacedMap& map, const Body& body, const LocalizeConfig& config = {});
  ~Localizer();
  Localizer(Localizer&&) noexcept;

  /// Takes the observation after the last action. kKnown and kUnknown are final.
  LocalizeStep Step(const Observation& obs);

  int actions() const;  ///< requested so far
  /// The hypotheses of the last attempt, best first.
  const std::vector<Hypothesis>& hypotheses() const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::localization
