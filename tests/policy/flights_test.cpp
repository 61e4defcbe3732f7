// SPDX-License-Identifier: MIT
#include "crossnav/policy/flights.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace crossnav::policy {
namespace {

using geometry::StairFlight;

std::vector<Vector3d> Path(double from_x, double to_x, double rise_m) {
  std::vector<Vector3d> path;
  for (int i = 0; i <= 10; ++i)
    path.emplace_back(from_x + (to_x - from_x) * i / 10, 1.0, rise_m * i / 10);
  return path;
}

TEST(Flights, AWalkGivesAFlightFromFootToTop) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Path(0, 4, 2.8), {}, 0.1, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].p_foot_world, Vector3d(0, 1, 0));
  EXPECT_EQ(flights[0].p_top_world, Vector3d(4, 1, 2.8));
  EXPECT_EQ(flights[0].walked_up, 1);
  EXPECT_EQ(flights[0].walked_down, 0);
  EXPECT_EQ(flights[0].confidence, 0);
}

TEST(Flights, TheWalkBackIsTheSameFlight) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Path(0, 4, 2.8), {}, 0.1, &flights);
  auto back = Path(0.3, 4.2, 2.8);
  std::reverse(back.begin(), back.end());
  NoteWalk(back, {}, 0.1, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].walked_up, 1);
  EXPECT_EQ(flights[0].walked_down, 1);
}

TEST(Flights, ANeighbouringFlightIsAnother) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Path(0, 4, 2.8), {}, 0.1, &flights);
  NoteWalk(Path(4, 0, 2.8), {}, 0.1, &flights);
  EXPECT_EQ(flights.size(), 2u);
}

TEST(Flights, APointOnAFlightIsBesideIt) {
  std::vector<geometry::StairFlight> flights;
  NoteWalk(Path(0, 4, 2.8), {}, 0.1, &flights);
  EXPECT_TRUE(IsBeside(flights[0], {2, 1.4, 1.5}));
  EXPECT_TRUE(IsBeside(flights[0], {4, 1, 2.8}));
  EXPECT_FALSE(IsBeside(flights[0], {2, 1.4, 2.8}));  // the gallery above its middle
  EXPECT_FALSE(IsBeside(flights[0], {2, 3, 1.4}));
}

StairFlight Seen(double from_x, double to_x, double rise_m, int id) {
  StairFlight flight;
  flight.id = id;
  flight.steps_world = Path(from_x, to_x, rise_m);
  flight.p_foot_world = flight.steps_world.front();
  flight.p_top_world = flight.steps_world.back();
  return flight;
}

TEST(Flights, AWalkTakesOverTheSeenFlight) {
  std::vector<StairFlight> flights = {Seen(1, 4, 2.1, 5), Seen(10, 14, 2.8, 6)};
  flights[0].seen_from_world = {{0, 0, 0}};
  NoteTry({2, 1, 1}, {{-1, 0, 0}, true, geometry::TryEnding::kUnreachable}, &flights);
  NoteWalk(Path(0, 4, 2.8), {}, 0.1, &flights);
  ASSERT_EQ(flights.size(), 2u);
  EXPECT_TRUE(flights[0].IsWalked());
  EXPECT_EQ(flights[0].id, 5);
  EXPECT_EQ(flights[0].seen_from_world.size(), 1u);
  ASSERT_EQ(flights[0].tries.size(), 1u);
  EXPECT_EQ(flights[0].tries[0].ending, geometry::TryEnding::kUnreachable);
  EXPECT_FALSE(flights[1].IsWalked());
}

TEST(Flights, ATryIsRememberedWhereTheFlightIs) {
  std::vector<StairFlight> flights = {Seen(0, 4, 2.8, 0)};
  NoteTry({20, 1, 1}, {{-1, 0, 0}, true, geometry::TryEnding::kNoProgress}, &flights);
  EXPECT_TRUE(flights[0].tries.empty());
  NoteTry({0.5, 1, 0.3}, {{-1, 0, 0}, true, geometry::TryEnding::kNoProgress}, &flights);
  EXPECT_EQ(flights[0].tries.size(), 1u);
}

TEST(Flights, TheDirectionIsThatOfTheFirstSteps) {
  StairFlight flight = Seen(0, 4, 2.8, 0);
  EXPECT_EQ(flight.DirectionUp(), Vector3d(1, 0, 0));
  flight.steps_world.push_back({4, 30, 2.9});  // turns, far from the foot
  EXPECT_EQ(flight.DirectionUp(), Vector3d(1, 0, 0));
  EXPECT_EQ(StairFlight{}.DirectionUp(), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace crossnav::policy
