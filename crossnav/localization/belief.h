// SPDX-License-Identifier: MIT
// Belief over the pose: distinct hypotheses, best first, and whether the best is confirmed. Frames:
// map, and odom of the scan.
#pragma once

#include <string_view>
#include <vector>

#include "crossnav/core/action.h"
#include "crossnav/localization/hypothesis.h"
#include "crossnav/localization/local_scan.h"
#include "crossnav/localization/placed_map.h"

namespace crossnav::localization {

enum class Status { kLocalising, kKnown, kUnknown };

/// "localising", "known", "unknown".
std::string_view NameOf(Status status);

struct LocalizeStep {
  Status status = Status::kLocalising;
  Action action = Action::kStop;       ///< while localising
  Pose T_map_odom = Pose::Identity();  ///< of the best hypothesis; valid once known
  double agreement = 0;                ///< of the best hypothesis
  double lead = 0;                     ///< over the nearest rival, as a share of all beams
  Lead nearest;                        ///< the same lead in beams
  int rivals = 0;                      ///< hypotheses that cannot be told from the best hypothesis
  bool is_pinned = false;              ///< no small shift of the best scores about as well
};

class Belief {
 public:
  /// Keeps a reference to `map`.
  Belief(const PlacedMap& map, const LocalizeConfig& config) : map_(map), config_(config) {}

  /// Searches the whole map; keeps the previous hypotheses.
  void Search(const LocalScan& scan, const Vector3d& p_foot_odom);

  /// Updates the hypotheses with the scan.
  void Recheck(const LocalScan& scan, const Vector3d& p_foot_odom);

  const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  /// kKnown: the beams agree with the best hypothesis, its lead is decisive, and it is pinned.
  const LocalizeStep& opinion() const { return opinion_; }

 private:
  void Keep(std::vector<Hypothesis> all, const LocalScan& scan, const Vector3d& p_foot_odom);
  bool IsAhead(const Lead& lead, std::size_t beams) const;
  bool IsPinned(const std::vector<Vector3f>& points, const Vector3d& p_foot_odom) const;
  void Judge(const LocalScan& scan, const Vector3d& p_foot_odom);

  const PlacedMap& map_;
  LocalizeConfig config_;
  std::vector<Hypothesis> hypotheses_;
  LocalizeStep opinion_;
};

}  // namespace crossnav::localization
