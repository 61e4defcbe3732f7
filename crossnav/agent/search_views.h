// SPDX-License-Identifier: MIT
// Views of a search: from a place and in a heading, the patches that the goal may stand on
// unnoticed and that would come into sight. The camera looks in the pitch of travel, or level: tops
// of furniture above the camera are out of the lowered picture from near. World frame, metres.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

// chosen: a view of less probability is not worth a step
inline constexpr double kLeastGain = 0.004;

/// Chance that the goal stands at the patch and was not noticed, given that it stands there. A wide
/// goal shows at the patches beside it, too.
double Unnoticed(const policy::SearchField& field, const geometry::VoxelKey& cell,
                 const policy::SearchPatch& patch, const ObjectSearch& search);

/// Places of one coarse cell have the same views.
geometry::VoxelKey ViewCellOf(const geometry::VoxelKey& place);

/// Patches that no place shows, within reach or not: a way that is closed may be opened.
std::set<geometry::VoxelKey> PatchesOutOfSight(const Situation& now, const ObjectSearch& goal);

/// Patches that no place within reach of `start` shows.
std::set<geometry::VoxelKey> PatchesOutOfReach(const Situation& now,
                                               const geometry::VoxelKey& start,
                                               const ObjectSearch& goal);

struct SearchView {
  double gain = 0;    ///< probability that the goal is in it, unnoticed so far
  double cost_m = 0;  ///< path and turns
  double heading_rad = 0;
  double pitch_rad = 0;
  std::vector<geometry::VoxelKey> cells;  ///< patches that it shows
};

/// Views of one choice, while a search is on. Keeps a reference to the situation.
class SearchViews {
 public:
  explicit SearchViews(const Situation& now);

  /// More than any view from `place` can gain.
  double Bound(const geometry::VoxelKey& place) const;

  /// The view with the least cost for its gain, from the end of a path of `path_m` at which the
  /// agent arrives in the heading `arrival_rad`. nullopt where no view gains enough.
  std::optional<SearchView> From(const geometry::VoxelKey& place, double path_m,
                                 double arrival_rad) const;

 private:
  struct Open {
    geometry::VoxelKey cell;
    Vector3d p_world;
    double gain = 0;
  };
  struct Seen {
    const Open* open;
    double bearing_rad;
    double elevation_rad;
  };

  std::vector<Seen> SeenFrom(const geometry::VoxelKey& place) const;
  bool IsInRange(const Vector3d& p_eye, const Vector3d& p_world) const;

  const Situation& now_;
  std::vector<Open> open_;
  double range_m_ = 0, half_width_rad_ = 0, half_height_rad_ = 0;
};

}  // namespace crossnav::agent
