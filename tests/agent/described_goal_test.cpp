// SPDX-License-Identifier: MIT
// A long room with a grey and a red couch: the description decides which couch is claimed.
#include <gtest/gtest.h>

#include "agent/two_couches.h"

namespace crossnav::agent {
namespace {

using test::BoxWalker;
using test::FakeSuite;
using testing::InColour;
using testing::kGrey;
using testing::kRed;
using testing::LongRoom;
using testing::SmallConfig;
using testing::TwoSofas;

/// Where the agent claims the goal; nothing where it does not.
std::optional<Vector3d> ClaimOf(const std::string& goal) {
  BoxWalker walker = LongRoom();
  Agent agent(SmallConfig(), FakeSuite(TwoSofas()));
  const auto set = agent.SetGoal(goal);
  EXPECT_TRUE(set) << (set ? "" : set.error().Message());
  for (int i = 0; set && i < 600; ++i) {
    const auto result = agent.Step(InColour(walker));
    if (!result || result->all_explored) return std::nullopt;
    if (result->action == Action::kStop) return result->p_claimed_world;
    walker.Do(result->action);
  }
  return std::nullopt;
}

bool IsAt(const std::optional<Vector3d>& claim, const Box3& box) {
  return claim && box.HorizontalDistance(*claim) < 0.3;
}

TEST(DescribedGoal, TheInstanceThatFitsIsClaimedAndNotTheOneBeforeIt) {
  EXPECT_TRUE(IsAt(ClaimOf("sofa"), kGrey));
  EXPECT_TRUE(IsAt(ClaimOf("the grey couch"), kGrey));
  EXPECT_TRUE(IsAt(ClaimOf("the red couch"), kRed));
}

TEST(DescribedGoal, WhatNothingFitsIsNotClaimed) {
  EXPECT_FALSE(ClaimOf("the green couch").has_value());
  EXPECT_FALSE(ClaimOf("the red couch upstairs").has_value());
}

TEST(DescribedGoal, OrdinalsCountFromTheStartOnceEverythingWasSeen) {
  EXPECT_TRUE(IsAt(ClaimOf("the second couch"), kRed));
  EXPECT_TRUE(IsAt(ClaimOf("the first couch"), kGrey));
  EXPECT_FALSE(ClaimOf("the third couch").has_value());
}

TEST(DescribedGoal, WordsThatAreNotUnderstoodAreAnError) {
  Agent agent(SmallConfig(), FakeSuite(TwoSofas()));
  const auto set = agent.SetGoal("the leftmost couch");
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().what.find("leftmost"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::agent
