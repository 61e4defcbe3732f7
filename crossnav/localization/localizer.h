// SPDX-License-Identifier: MIT
// "Awake and lost": finds the pose in a saved map, one observation in, one action out. Looks around
// first; where that leaves more than one hypothesis, walks to where their predictions differ.
// "Unknown" is an answer. The odometry's poses are right relative to each other; where its frame
// lies in the map is what is asked. Deterministic; not thread-safe.
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

  /// Takes what was seen after the last action. After kKnown or kUnknown the answer stays.
  LocalizeStep Step(const Observation& obs);

  int actions() const;  ///< asked for so far
  /// The hypotheses of the last attempt, best first.
  const std::vector<Hypothesis>& hypotheses() const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::localization
