// SPDX-License-Identifier: MIT
// "Awake and lost": finds the pose in a saved map, one observation in, one action out. Looks around
// first; where that leaves more than one hypothesis, walks to where their predictions differ.
// "Unknown" is an answer. The odometry's poses are right relative to each other; where its frame
// lies in the map is what is asked. Deterministic; not thread-safe.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/localization/hypothesis.h"
#include "crossnav/localization/local_scan.h"
#include "crossnav/localization/localize_config.h"
#include "crossnav/localization/placed_map.h"

namespace crossnav::localization {

enum class Status { kLocalising, kKnown, kUnknown };

/// "localising", "known", "unknown".
std::string_view NameOf(Status status);

struct LocalizeStep {
  Status status = Status::kLocalising;
  Action action = Action::kStop;       ///< while localising
  Pose T_map_odom = Pose::Identity();  ///< once known
  double agreement = 0;                ///< of the best hypothesis
  double lead = 0;                     ///< of it over the nearest rival, as a share of all beams
  Lead nearest;                        ///< the same in beams
  int rivals = 0;                      ///< hypotheses that could not be told from the best
};

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
