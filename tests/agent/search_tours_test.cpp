// SPDX-License-Identifier: MIT
// Prices of rooms and floors in the search of a known house.
#include "crossnav/agent/search_tours.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crossnav::agent {
namespace {

TEST(SearchTours, AFloorCostsThePathToItAndItsBestRooms) {
  const RoomTour hall{0, 0.3, 5}, attic{0, 0.1, 20}, study{0, 0.2, 5};
  EXPECT_DOUBLE_EQ(PriceOfTours({hall}, 10), 15 / 0.3);
  // The study is on the way for its probability, the attic is not.
  EXPECT_DOUBLE_EQ(PriceOfTours({attic, study, hall}, 10), 20 / 0.5);
  EXPECT_TRUE(std::isinf(PriceOfTours({}, 10)));
}

TEST(SearchTours, AFartherFloorCostsMore) {
  const RoomTour hall{0, 0.3, 5};
  EXPECT_LT(PriceOfTours({hall}, 10), PriceOfTours({hall}, 12));
}

}  // namespace
}  // namespace crossnav::agent
