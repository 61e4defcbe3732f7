// SPDX-License-Identifier: MIT
#include "crossnav/policy/whereabouts.h"

#include <gtest/gtest.h>

namespace crossnav::policy {
namespace {

TEST(Whereabouts, BedsLieAboveAndSofasBelow) {
  EXPECT_GT(UpperStoreyBits("bed"), 1);
  EXPECT_LT(UpperStoreyBits("sofa"), -1);
  EXPECT_EQ(UpperStoreyBits("Couch"), UpperStoreyBits("sofa"));
}

TEST(Whereabouts, UnbiasedAndUnknownObjectsHaveNoFloorPrior) {
  for (const char* goal : {"chair", "plant", "toilet", "tv_monitor", "zebra", ""})
    EXPECT_EQ(UpperStoreyBits(goal), 0) << goal;
}

}  // namespace
}  // namespace crossnav::policy
