// SPDX-License-Identifier: MIT
// A long room with a grey and a red couch: the description decides which couch is claimed.
#include <gtest/gtest.h>

#include "agent/two_couches.h"

namespace crossnav::agent {
namespace {

using test::FakeSuite;
using testing::IsClaimAt;
using testing::kGrey;
using testing::kRed;
using testing::SmallConfig;
using testing::TwoSofas;

/// Claim of the goal's instance; nullopt without a claim.
std::optional<Vector3d> ClaimOf(const std::string& goal) {
  Agent agent(SmallConfig(), FakeSuite(TwoSofas()));
  const auto set = agent.SetGoal(goal);
  EXPECT_TRUE(set) << (set ? "" : set.error().Message());
  return set ? testing::ClaimIn600Steps(agent) : std::nullopt;
}

TEST(DescribedGoal, TheInstanceThatFitsIsClaimedAndNotTheOneBeforeIt) {
  EXPECT_TRUE(IsClaimAt(ClaimOf("sofa"), kGrey));
  EXPECT_TRUE(IsClaimAt(ClaimOf("the grey couch"), kGrey));
  EXPECT_TRUE(IsClaimAt(ClaimOf("the red couch"), kRed));
}

TEST(DescribedGoal, WhatNothingFitsIsNotClaimed) {
  EXPECT_FALSE(ClaimOf("the green couch").has_value());
  EXPECT_FALSE(ClaimOf("the red couch upstairs").has_value());
}

TEST(DescribedGoal, OrdinalsCountFromTheStartOnceEverythingWasSeen) {
  EXPECT_TRUE(IsClaimAt(ClaimOf("the second couch"), kRed));
  EXPECT_TRUE(IsClaimAt(ClaimOf("the first couch"), kGrey));
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
