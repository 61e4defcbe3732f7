// SPDX-License-Identifier: MIT
#include "crossnav/policy/flights.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace crossnav::policy {
namespace {

std::vector<Vector3d> Way(double from_x, double to_x, double rise_m) {
  std::vector<Vector3d> way;
  for (int i = 0; i <= 10; ++i)
    way.emplace_back(from_x + (to_x - from_x) * i / 10, 1.0, rise_m * i / 10);
  return way;
}

TEST(Flights, AWalkGivesAFlightFromFootToTop) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Way(0, 4, 2.8), {}, 0.1, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].p_foot_world, Vector3d(0, 1, 0));
  EXPECT_EQ(flights[0].p_top_world, Vector3d(4, 1, 2.8));
  EXPECT_EQ(flights[0].walked_up, 1);
  EXPECT_EQ(flights[0].walked_down, 0);
  EXPECT_EQ(flights[0].confidence, 0);
}

TEST(Flights, TheWayBackIsTheSameFlight) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Way(0, 4, 2.8), {}, 0.1, &flights);
  auto back = Way(0.3, 4.2, 2.8);
  std::reverse(back.begin(), back.end());
  NoteWalk(back, {}, 0.1, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].walked_up, 1);
  EXPECT_EQ(flights[0].walked_down, 1);
}

TEST(Flights, ANeighbouringFlightIsAnother) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Way(0, 4, 2.8), {}, 0.1, &flights);
  NoteWalk(Way(4, 0, 2.8), {}, 0.1, &flights);
  EXPECT_EQ(flights.size(), 2u);
}

TEST(Flights, WhatLiesOnOneIsBesideIt) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Way(0, 4, 2.8), {}, 0.1, &flights);
  EXPECT_TRUE(IsBeside(flights[0], {2, 1.4, 1.5}));
  EXPECT_TRUE(IsBeside(flights[0], {4, 1, 2.8}));
  EXPECT_FALSE(IsBeside(flights[0], {2, 1.4, 2.8}));  // the gallery above its middle
  EXPECT_FALSE(IsBeside(flights[0], {2, 3, 1.4}));
}

}  // namespace
}  // namespace crossnav::policy
