// SPDX-License-Identifier: MIT
#include "crossnav/policy/modes.h"

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace crossnav::policy {
namespace {

using Set = bool ModeInputs::*;

struct Row {
  const char* story;
  Mode mode;
  std::vector<Set> flags;
  Mode next;
  ModeReason reason;
  bool uses_live_poi = false;
};

constexpr Mode kBasic = Mode::kBasicExplore, kStairs = Mode::kStairExplore,
               kPoi = Mode::kPoiNavigation, kTarget = Mode::kTargetApproach;

std::vector<Row> Table() {
  using In = ModeInputs;
  using R = ModeReason;
  const Set is_new = &In::is_new_goal, entrance = &In::entrance_verified,
            landing = &In::session_on_landing, lost = &In::session_failed, live = &In::has_live_poi,
            same = &In::live_near_history, history = &In::has_history_poi,
            bound = &In::is_following_history, near = &In::is_near_viewpoint,
            refuted = &In::verification_failed;
  return {
      {"a goal begins with exploring", kBasic, {is_new}, kBasic, R::kStart},
      {"nothing seen, nothing known", kBasic, {}, kBasic, R::kExploring},
      {"stairs confirmed at the entrance", kBasic, {entrance}, kStairs, R::kEntranceVerified},
      {"an entrance beats every POI",
       kBasic,
       {entrance, live, history, near},
       kStairs,
       R::kEntranceVerified},
      {"the session keeps control", kStairs, {}, kStairs, R::kClimbing},
      {"even when the goal is seen", kStairs, {live, near, history}, kStairs, R::kClimbing},
      {"the landing ends it", kStairs, {landing}, kBasic, R::kLandingReached},
      {"the landing counts before a failure", kStairs, {landing, lost}, kBasic, R::kLandingReached},
      {"no way on ends it", kStairs, {lost, live}, kBasic, R::kSessionFailed},
      {"a new goal ends it", kStairs, {is_new}, kBasic, R::kStart},
      {"a new goal that is remembered", kStairs, {is_new, history}, kPoi, R::kHistoryPoi},
      {"the goal is seen", kBasic, {live}, kPoi, R::kLivePoi, true},
      {"seen beats remembered", kBasic, {live, history}, kPoi, R::kLivePoi, true},
      {"seen, and near", kBasic, {live, near}, kTarget, R::kNearTarget, true},
      {"near means nothing without a goal in sight", kBasic, {near}, kBasic, R::kExploring},
      {"the goal is remembered", kBasic, {history}, kPoi, R::kHistoryPoi},
      {"a live POI elsewhere does not distract",
       kPoi,
       {live, history, bound, near},
       kPoi,
       R::kHistoryPoi},
      {"one at the remembered place takes over",
       kPoi,
       {live, history, bound, same},
       kPoi,
       R::kLiveTakeover,
       true},
      {"takes over, and near",
       kPoi,
       {live, history, bound, same, near},
       kTarget,
       R::kNearTarget,
       true},
      {"a lost history POI binds no more", kPoi, {live, bound}, kPoi, R::kLivePoi, true},
      {"the remembered place was wrong", kPoi, {bound}, kBasic, R::kPoiExhausted},
      {"refuted", kPoi, {refuted}, kBasic, R::kVerificationFailed},
      {"the aimed object is out of sight", kTarget, {}, kBasic, R::kExploring},
      {"refuted close up", kTarget, {refuted}, kBasic, R::kVerificationFailed},
      {"refuted, another place is remembered", kTarget, {refuted, history}, kPoi, R::kHistoryPoi},
      {"aiming goes on", kTarget, {live, near}, kTarget, R::kNearTarget, true},
      {"pushed away from the viewpoint", kTarget, {live}, kPoi, R::kLivePoi, true},
  };
}

TEST(NextMode, EveryRowOfTheTableGivesItsModeAndReason) {
  for (const Row& row : Table()) {
    ModeInputs in;
    in.mode = row.mode;
    for (const Set flag : row.flags) in.*flag = true;
    const ModeDecision next = NextMode(in);
    EXPECT_EQ(NameOf(next.mode), NameOf(row.next)) << row.story;
    EXPECT_EQ(NameOf(next.reason), NameOf(row.reason)) << row.story;
    EXPECT_EQ(next.uses_live_poi, row.uses_live_poi) << row.story;
  }
}

TEST(NextMode, TheTableShowsEveryReason) {
  std::set<ModeReason> seen;
  for (const Row& row : Table()) seen.insert(row.reason);
  EXPECT_EQ(static_cast<int>(seen.size()), static_cast<int>(ModeReason::kVerificationFailed) + 1);
}

TEST(NextMode, EveryInputKeepsTheOrderOfPriorities) {
  const std::vector<Set> flags = {
      &ModeInputs::is_new_goal,        &ModeInputs::entrance_verified,
      &ModeInputs::session_on_landing, &ModeInputs::session_failed,
      &ModeInputs::has_live_poi,       &ModeInputs::live_near_history,
      &ModeInputs::has_history_poi,    &ModeInputs::is_following_history,
      &ModeInputs::is_near_viewpoint,  &ModeInputs::verification_failed};
  for (const Mode mode : {kBasic, kStairs, kPoi, kTarget})
    for (unsigned bits = 0; bits < 1u << flags.size(); ++bits) {
      ModeInputs in;
      in.mode = mode;
      for (std::size_t i = 0; i < flags.size(); ++i) in.*flags[i] = bits >> i & 1;
      const ModeDecision next = NextMode(in);
      const bool in_session = mode == kStairs && !in.is_new_goal;
      if (in_session) {
        EXPECT_EQ(next.mode == kStairs, !in.session_on_landing && !in.session_failed);
        EXPECT_FALSE(next.uses_live_poi);
        continue;
      }
      EXPECT_EQ(next.mode == kStairs, in.entrance_verified);
      if (next.mode == kStairs) continue;
      EXPECT_EQ(next.mode == kBasic, !in.has_live_poi && !in.has_history_poi);
      EXPECT_EQ(next.mode == kTarget, next.uses_live_poi && in.is_near_viewpoint);
      EXPECT_TRUE(in.has_live_poi || !next.uses_live_poi);
      const bool is_bound = mode == kPoi && in.is_following_history && in.has_history_poi;
      EXPECT_EQ(next.uses_live_poi, in.has_live_poi && (!is_bound || in.live_near_history));
    }
}

TEST(Modes, NamesAreDistinct) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(ModeReason::kVerificationFailed); ++i)
    names.insert(NameOf(static_cast<ModeReason>(i)));
  for (const Mode mode : {kBasic, kStairs, kPoi, kTarget}) names.insert(NameOf(mode));
  EXPECT_EQ(names.size(), 16u);
  EXPECT_FALSE(names.contains("unknown"));
}

}  // namespace
}  // namespace crossnav::policy
