// SPDX-License-Identifier: MIT
#include "crossnav/agent/activity.h"

namespace crossnav::agent {

std::string_view NameOf(ActivityKind kind) {
  switch (kind) {
    case ActivityKind::kNone:
      return "none";
    case ActivityKind::kLookAround:
      return "look_around";
    case ActivityKind::kGoTo:
      return "go_to";
    case ActivityKind::kClimb:
      return "climb";
    case ActivityKind::kVisit:
      return "visit";
    case ActivityKind::kApproach:
      return "approach";
  }
  return "unknown";
}

std::string_view NameOf(Ending ending) {
  switch (ending) {
    case Ending::kReached:
      return "reached";
    case Ending::kGone:
      return "gone";
    case Ending::kSuperseded:
      return "superseded";
    case Ending::kNotOpened:
      return "did not open";
    case Ending::kNoProgress:
      return "no progress";
    case Ending::kUnreachable:
      return "unreachable";
    case Ending::kRefuted:
      return "refuted";
  }
  return "unknown";
}

bool IsSpent(const std::vector<Attempt>& attempts, policy::CandidateKind kind,
             const Vector3d& p_focus_world, double same_place_m, int max_choices) {
  int choices = 0;
  for (const Attempt& attempt : attempts) {
    if (attempt.kind != kind) continue;
    if ((attempt.p_focus_world - p_focus_world).norm() > same_place_m) continue;
    switch (attempt.ending) {
      case Ending::kReached:
      case Ending::kNotOpened:
      case Ending::kNoProgress:
      case Ending::kRefuted:
        return true;
      case Ending::kGone:
        break;
      case Ending::kSuperseded:
      case Ending::kUnreachable:
        ++choices;
        break;
    }
  }
  return choices >= max_choices;
}

}  // namespace crossnav::agent
