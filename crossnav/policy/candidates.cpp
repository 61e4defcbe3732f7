// SPDX-License-Identifier: MIT
#include "crossnav/policy/candidates.h"

#include <algorithm>
#include <cmath>

namespace crossnav::policy {

std::string_view NameOf(CandidateKind kind) {
  switch (kind) {
    case CandidateKind::kLivePoi:
      return "live_poi";
    case CandidateKind::kHistoryPoi:
      return "history_poi";
    case CandidateKind::kTraversableFrontier:
      return "traversable_frontier";
    case CandidateKind::kDescendFrontier:
      return "descend_frontier";
    case CandidateKind::kAscentFrontier:
      return "ascent_frontier";
    case CandidateKind::kStairFrontier:
      return "stair_frontier";
    case CandidateKind::kSighting:
      return "sighting";
    case CandidateKind::kUninspected:
      return "uninspected";
    case CandidateKind::kSearchView:
      return "search_view";
    case CandidateKind::kClosedWay:
      return "closed_way";
  }
  return "unknown";
}

bool IsBlacklisted(const std::vector<BlacklistedPlace>& places, const Vector3d& p_world) {
  return std::any_of(places.begin(), places.end(), [&](const BlacklistedPlace& place) {
    const Vector3d d = p_world - place.p_world;
    return std::hypot(d.x(), d.y()) <= place.radius_m && std::abs(d.z()) <= place.half_height_m;
  });
}

}  // namespace crossnav::policy
