// SPDX-License-Identifier: MIT
// The four navigation modes (Table tab:supp_navigation_modes) and the one pure function that
// changes them. Every change carries a reason that the trace and the viewer show.
#pragma once

#include <string_view>

namespace crossnav::policy {

enum class Mode { kBasicExplore, kStairExplore, kPoiNavigation, kTargetApproach };

enum class ModeReason {
  kStart,               ///< a goal was activated
  kExploring,           ///< nothing better than frontiers
  kLivePoi,             ///< a stable detection of the goal is reachable
  kHistoryPoi,          ///< the memory knows a place that looks like the goal
  kLiveTakeover,        ///< a live POI near the history POI took over
  kNearTarget,          ///< close enough to the viewpoint to aim and verify
  kEntranceVerified,    ///< stairs confirmed at the entrance
  kClimbing,            ///< a session keeps control
  kLandingReached,      ///< the session ended on a new level
  kSessionFailed,       ///< no path on along the stairs
  kPoiExhausted,        ///< visited or refuted; back to the candidates
  kVerificationFailed,  ///< no viewpoint proved the object
};

std::string_view NameOf(Mode mode);
std::string_view NameOf(ModeReason reason);

/// Findings of the last step.
struct ModeInputs {
  Mode mode = Mode::kBasicExplore;
  bool is_new_goal = false;
  bool entrance_verified = false;   ///< stairs confirmed where the agent stands
  bool session_on_landing = false;  ///< landing confirmed and no flight continues
  bool session_failed = false;
  bool has_live_poi = false;  ///< stable, with a reachable viewpoint
  bool live_near_history =
      false;  ///< that POI lies within the takeover radius of the active history POI
  bool has_history_poi = false;       ///< reachable and not blacklisted
  bool is_following_history = false;  ///< the POI being navigated to is a history POI
  bool is_near_viewpoint = false;     ///< of the live POI
  bool verification_failed = false;   ///< the approached POI was refuted in the last step
};

struct ModeDecision {
  Mode mode;
  ModeReason reason;
  bool uses_live_poi = false;  ///< in POI navigation: live instead of history
};

/// Pure. Stair sessions keep control; live POIs beat history POIs beat exploration.
ModeDecision NextMode(const ModeInputs& in);

}  // namespace crossnav::policy
