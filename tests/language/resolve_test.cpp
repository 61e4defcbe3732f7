// SPDX-License-Identifier: MIT
#include "crossnav/language/resolve.h"

#include <gtest/gtest.h>

#include "crossnav/language/parse_description.h"
#include "language/small_home.h"

namespace crossnav::language {
namespace {

struct Resolving : SmallHome, testing::Test {
  Resolution Of(const std::string& text) { return Resolve(ParseDescription(text).value(), home); }
  /// Index of the found thing, or -1.
  int One(const std::string& text) {
    const Resolution r = Of(text);
    return r.outcome == Outcome::kFound ? r.things.at(0) : -1;
  }
};

TEST_F(Resolving, EachWordNarrowsToTheThingThatIsMeant) {
  EXPECT_EQ(One("the sofa"), sofa);
  EXPECT_EQ(One("the red chair upstairs"), upper_chair);
  EXPECT_EQ(One("the red chair downstairs"), far_chair);
  EXPECT_EQ(One("the chair next to the table"), near_chair);
  EXPECT_EQ(One("the plant on the dining table"), plant);
  EXPECT_EQ(One("the table under the plant"), table);
  EXPECT_EQ(One("the chair in the bedroom"), upper_chair);
  EXPECT_EQ(One("a bed on the first floor"), bed);
  EXPECT_EQ(One("the red chair in the kitchen"), far_chair);
  EXPECT_EQ(One("the big table"), table);
  EXPECT_EQ(One("the small table"), sofa + 1);
}

TEST_F(Resolving, SeveralThatFitAreAmbiguousUnlessAnyWillDo) {
  const Resolution chairs = Of("the chair");
  EXPECT_EQ(chairs.outcome, Outcome::kAmbiguous);
  EXPECT_EQ(chairs.things.size(), 3U);
  EXPECT_EQ(Of("the red chair").outcome, Outcome::kAmbiguous);
  EXPECT_EQ(Of("a chair").outcome, Outcome::kFound);
}

TEST_F(Resolving, NoneIsAbsentWhereItWasLookedForAndElseUnknown) {
  EXPECT_EQ(Of("the toilet downstairs").outcome, Outcome::kAbsent);
  EXPECT_EQ(Of("the toilet").outcome, Outcome::kUnknown) << "a room upstairs was not looked at";
  EXPECT_EQ(Of("the green chair downstairs").outcome, Outcome::kAbsent);
  EXPECT_EQ(Of("the chair on the second floor").outcome, Outcome::kUnknown);
  EXPECT_EQ(Of("the chair near the sofa").outcome, Outcome::kUnknown);
}

TEST_F(Resolving, OrdinalsCountFromTheRobotOnItsOwnFloorFirst) {
  EXPECT_EQ(Of("the second chair").outcome, Outcome::kAmbiguous) << "nobody stands anywhere";
  home.p_robot_world = Vector3d(0, 3, 0);
  EXPECT_EQ(One("the first chair"), far_chair);
  EXPECT_EQ(One("the second chair"), near_chair);
  EXPECT_EQ(One("the last chair"), upper_chair);
  EXPECT_EQ(Of("the fourth chair").outcome, Outcome::kAbsent);
  home.p_robot_world = Vector3d(4, 2, 2.8);
  EXPECT_EQ(One("the nearest chair"), upper_chair);
  EXPECT_EQ(One("the chair next to the second table"), -1);
}

TEST_F(Resolving, AWallPartsWhatIsNear) {
  EXPECT_EQ(One("the chair near the table"), near_chair);
  home.things[near_chair].room = 1;
  EXPECT_NE(One("the chair near the dining table"), near_chair);
}

TEST_F(Resolving, FloorsAreAGuessWhileStairsLeadOn) {
  home.may_have_more_floors = true;
  EXPECT_FALSE(Of("the sofa on the ground floor").is_sure);
  EXPECT_NE(Of("the bed on the ground floor").outcome, Outcome::kFound);
  EXPECT_TRUE(Of("the bed upstairs").is_sure);
}

TEST_F(Resolving, WhatWasNeverSeenInColourIsAGuess) {
  home.things[sofa].colour.reset();
  const Resolution guess = Of("the blue sofa");
  EXPECT_EQ(guess.outcome, Outcome::kFound);
  EXPECT_FALSE(guess.is_sure);
  EXPECT_TRUE(Of("the sofa").is_sure);
}

TEST_F(Resolving, FloorsAreCountedFromTheGround) {
  home.ground_floor = 1;
  EXPECT_EQ(One("the sofa in the basement"), sofa);
  EXPECT_EQ(One("the bed on the ground floor"), bed);
  home.p_robot_world = Vector3d(0, 0, 0);
  EXPECT_EQ(One("the bed upstairs"), bed);
  home.p_robot_world = Vector3d(0, 0, 2.8);
  home.ground_floor = 0;
  EXPECT_EQ(One("the bed upstairs"), bed) << "from the top floor, upstairs is above the ground";
}

}  // namespace
}  // namespace crossnav::language
