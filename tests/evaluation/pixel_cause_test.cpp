// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/pixel_cause.h"

#include <gtest/gtest.h>

namespace crossnav::evaluation {
namespace {

StageRecord Failed(Outcome outcome, const StageCause& cause = {}) {
  StageRecord stage;
  stage.goal = "toilet";
  stage.outcome = outcome;
  stage.extra.cause = cause;
  return stage;
}

TEST(PixelCause, IsOfTheNetworkTheMaskTheMemoryTheStairsOrTheLegs) {
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kMisdetection)), "mistaken");
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kNotReached)), "mask");
  StageRecord passed = Failed(Outcome::kOutOfTime);
  passed.extra.passed_target = true;
  EXPECT_EQ(PixelCauseOf(passed), "missed");
  StageCause cause;
  cause.flight = FlightCause{1, 1, false, false, false};
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kOutOfTime, cause)), "stairs unseen");
  cause.flight->seen = true;
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kOutOfTime, cause)), "reach");
  cause = {};
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kOutOfTime, cause)), "search");
  cause.last_ending = "go_to: no progress";
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kStuck, cause)), "reach");
  cause.seen_share = 0.95;
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kAllExplored, cause)), "missed");
  cause.last_ending = "approach: claim refuted";
  EXPECT_EQ(PixelCauseOf(Failed(Outcome::kAllExplored, cause)), "memory");
  StageRecord reached = Failed(Outcome::kSuccess);
  reached.success = true;
  EXPECT_EQ(PixelCauseOf(reached), "");
}

TEST(PixelCause, IsCountedByGoal) {
  std::vector<EpisodeRecord> episodes(2);
  episodes[0].stages = {Failed(Outcome::kMisdetection), Failed(Outcome::kNotReached)};
  episodes[1].stages = {Failed(Outcome::kMisdetection)};
  const auto counts = CountPixelCauses(episodes);
  ASSERT_EQ(counts.size(), 1U);
  EXPECT_EQ(counts[0].goal, "toilet");
  EXPECT_EQ(counts[0].stages[0], 2);  // mistaken
  EXPECT_EQ(counts[0].stages[2], 1);  // mask
}

}  // namespace
}  // namespace crossnav::evaluation
