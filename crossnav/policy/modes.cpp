// SPDX-License-Identifier: MIT
#include "crossnav/policy/modes.h"

namespace crossnav::policy {

std::string_view NameOf(Mode mode) {
  switch (mode) {
    case Mode::kBasicExplore:
      return "basic_explore";
    case Mode::kStairExplore:
      return "stair_explore";
    case Mode::kPoiNavigation:
      return "poi_navigation";
    case Mode::kTargetApproach:
      return "target_approach";
  }
  return "unknown";
}

std::string_view NameOf(ModeReason reason) {
  switch (reason) {
    case ModeReason::kStart:
      return "goal activated";
    case ModeReason::kExploring:
      return "exploring frontiers";
    case ModeReason::kLivePoi:
      return "goal seen";
    case ModeReason::kHistoryPoi:
      return "goal remembered";
    case ModeReason::kLiveTakeover:
      return "goal seen where remembered";
    case ModeReason::kNearTarget:
      return "near the target";
    case ModeReason::kEntranceVerified:
      return "stairs verified";
    case ModeReason::kClimbing:
      return "on the stairs";
    case ModeReason::kLandingReached:
      return "landing reached";
    case ModeReason::kSessionFailed:
      return "stairs given up";
    case ModeReason::kPoiExhausted:
      return "remembered place was wrong";
    case ModeReason::kVerificationFailed:
      return "verification failed";
  }
  return "unknown";
}

ModeDecision NextMode(const ModeInputs& in) {
  if (in.mode == Mode::kStairExplore && !in.is_new_goal) {
    if (in.session_on_landing) return {Mode::kBasicExplore, ModeReason::kLandingReached};
    if (in.session_failed) return {Mode::kBasicExplore, ModeReason::kSessionFailed};
    return {Mode::kStairExplore, ModeReason::kClimbing};
  }
  if (in.entrance_verified) return {Mode::kStairExplore, ModeReason::kEntranceVerified};

  const bool is_bound_to_history =
      in.mode == Mode::kPoiNavigation && in.is_following_history && in.has_history_poi;
  if (in.has_live_poi && (!is_bound_to_history || in.live_near_history)) {
    if (in.is_near_viewpoint) return {Mode::kTargetApproach, ModeReason::kNearTarget, true};
    return {Mode::kPoiNavigation,
            is_bound_to_history ? ModeReason::kLiveTakeover : ModeReason::kLivePoi, true};
  }
  if (in.has_history_poi) return {Mode::kPoiNavigation, ModeReason::kHistoryPoi, false};
  if (in.verification_failed) return {Mode::kBasicExplore, ModeReason::kVerificationFailed};
  if (in.mode == Mode::kPoiNavigation) return {Mode::kBasicExplore, ModeReason::kPoiExhausted};
  return {Mode::kBasicExplore, in.is_new_goal ? ModeReason::kStart : ModeReason::kExploring};
}

}  // namespace crossnav::policy
