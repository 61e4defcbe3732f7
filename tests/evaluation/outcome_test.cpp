// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/outcome.h"

#include <gtest/gtest.h>

namespace crossnav::evaluation {
namespace {

const EvalConfig kEval;

Target SofaOnFloor(int floor) {
  Target target;
  target.instance = 1;
  target.box.Add({2, 2, 3.0 * floor});
  target.box.Add({4, 3, 3.0 * floor + 0.8});
  target.viewpoints_world = {{2, 1.5, 3.0 * floor}};
  target.floors = {floor};
  return target;
}

TEST(BoxRadius, IsHorizontalToTheBoxAndOnTheInstancesFloor) {
  const Target sofa = SofaOnFloor(0);
  EXPECT_TRUE(IsWithinBoxRadius(sofa, {3, 0.5, 0}, 0, kEval));    // exactly 1.50 m
  EXPECT_FALSE(IsWithinBoxRadius(sofa, {3, 0.49, 0}, 0, kEval));  // a little more
  EXPECT_TRUE(IsWithinBoxRadius(sofa, {3, 2.5, 0}, 0, kEval));    // inside
  EXPECT_FALSE(IsWithinBoxRadius(sofa, {3, 1.5, 3}, 1, kEval));   // right above it
}

TEST(BoxRadius, AnInvisibleInstanceIsNeverReached) {
  Target hidden = SofaOnFloor(0);
  hidden.floors.clear();
  EXPECT_FALSE(IsWithinBoxRadius(hidden, {3, 2, 0}, 0, kEval));
}

TEST(WrongFloor, NeedsAnInstanceBelowOrAboveAndNoneHere) {
  EXPECT_TRUE(IsOnWrongFloor({SofaOnFloor(0)}, {3, 1.5, 3}, 1, kEval));
  EXPECT_FALSE(IsOnWrongFloor({SofaOnFloor(0), SofaOnFloor(1)}, {3, 1.5, 3}, 1, kEval));
  EXPECT_FALSE(IsOnWrongFloor({SofaOnFloor(0)}, {9, 9, 3}, 1, kEval));
}

/// Every combination, against the precedence as the benchmark writes it.
TEST(JudgeStage, FollowsThePrecedence) {
  for (int bits = 0; bits < 32; ++bits) {
    StageEnd end;
    end.stopped = bits & 1;
    end.is_reached = bits & 2;
    end.is_claim_near = bits & 4;
    end.all_explored = bits & 8;
    end.recent_path_m = bits & 16 ? 0.049 : 0.05;
    Outcome expected = Outcome::kOutOfTime;
    if (end.stopped && end.is_reached) {
      expected = Outcome::kSuccess;
    } else if (end.stopped && end.is_claim_near) {
      expected = Outcome::kNotReached;
    } else if (end.stopped) {
      expected = Outcome::kMisdetection;
    } else if (end.all_explored) {
      expected = Outcome::kAllExplored;
    } else if (end.recent_path_m < 0.05) {
      expected = Outcome::kStuck;
    }
    EXPECT_EQ(JudgeStage(end, kEval), expected) << bits;
  }
}

trace::StepTrace WithEvents(std::vector<std::string> events) {
  trace::StepTrace step;
  step.events = std::move(events);
  return step;
}

TEST(StairWatch, NamesHowFarTheAgentGot) {
  StairWatch nothing;
  nothing.Add(WithEvents({"bump"}));
  EXPECT_EQ(nothing.Verdict(0), "never_found");
  StairWatch rejected;
  rejected.Add(WithEvents({"entrance rejected"}));
  EXPECT_EQ(rejected.Verdict(0), "entrance_rejected");
  StairWatch lost;
  lost.Add(WithEvents({"entrance rejected"}));
  lost.Add(WithEvents({"stairs up verified", "mode: stair_explore"}));
  EXPECT_EQ(lost.Verdict(0), "lost_on_flight");
  EXPECT_EQ(lost.Verdict(1), "landing_not_confirmed");
  lost.Add(WithEvents({"new level above"}));
  EXPECT_EQ(lost.Verdict(1), "");
}

}  // namespace
}  // namespace crossnav::evaluation
