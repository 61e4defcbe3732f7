// SPDX-License-Identifier: MIT
#include "crossnav/policy/flight_survey.h"

#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/policy/flights.h"

namespace crossnav::policy {
namespace {

using geometry::SeenStair;
using geometry::StairFlight;

constexpr double kVoxel_m = 0.1;

/// Confirmed evidence on a straight flight along x, a metre wide, 1.7 m of rise for 2.8 m of run.
std::vector<SeenStair> FlightEvidence(int from_x, int from_z, int layers, int y = 0) {
  std::vector<SeenStair> seen;
  for (int i = 0; i < layers; ++i)
    for (int dx = 0; dx < 2; ++dx)
      for (int dy = 0; dy < 10; ++dy)
        seen.push_back({{from_x + 2 * i + dx, y + dy, from_z + i}, 0.8F, 0.9F, true});
  return seen;
}

StairEvidence EvidenceOf(std::vector<SeenStair> seen) {
  StairEvidence evidence;
  evidence.Import(seen);
  return evidence;
}

TEST(FlightSurvey, EvidenceAloneIsAFlight) {
  std::vector<StairFlight> flights;
  FlightSurvey().Update(EvidenceOf(FlightEvidence(20, 1, 14)), {}, {0, 0, 0}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_FALSE(flights[0].IsWalked());
  EXPECT_EQ(flights[0].id, 0);
  EXPECT_NEAR(flights[0].p_foot_world.z(), 0.2, 1e-9);
  EXPECT_NEAR(flights[0].p_top_world.z(), 1.5, 1e-9);
  EXPECT_NEAR(flights[0].p_foot_world.y(), 0.5, 1e-9);
  EXPECT_NEAR(flights[0].confidence, 0.8, 1e-6);
  EXPECT_EQ(flights[0].DirectionUp(), Vector3d(1, 0, 0));
}

TEST(FlightSurvey, TwoStepsOrUnconfirmedEvidenceAreNoFlight) {
  std::vector<StairFlight> flights;
  FlightSurvey().Update(EvidenceOf(FlightEvidence(20, 1, 4)), {}, {0, 0, 0}, kVoxel_m, &flights);
  EXPECT_TRUE(flights.empty());
  auto unsure = FlightEvidence(20, 1, 14);
  for (SeenStair& stair : unsure) stair.is_confirmed = false;
  FlightSurvey().Update(EvidenceOf(unsure), {}, {0, 0, 0}, kVoxel_m, &flights);
  EXPECT_TRUE(flights.empty());
}

TEST(FlightSurvey, AFlightGrowsAndKeepsItsHistory) {
  std::vector<StairFlight> flights;
  FlightSurvey survey;
  survey.Update(EvidenceOf(FlightEvidence(20, 1, 7)), {}, {0, 0, 0}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 1u);
  NoteTry(flights[0].p_foot_world, {{1, 0, 0}, true, geometry::TryEnding::kNoProgress}, &flights);
  // The evidence is replaced, as by a file: the second import counts as a change.
  StairEvidence more = EvidenceOf({});
  more.Import(FlightEvidence(20, 1, 14));
  survey.Update(more, {}, {0, 0, 0}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_EQ(flights[0].id, 0);
  EXPECT_NEAR(flights[0].p_top_world.z(), 1.5, 1e-9);
  EXPECT_EQ(flights[0].tries.size(), 1u);
}

TEST(FlightSurvey, FlightsApartAreTwo) {
  auto both = FlightEvidence(20, 1, 14);
  const auto other = FlightEvidence(20, 1, 14, 40);
  both.insert(both.end(), other.begin(), other.end());
  std::vector<StairFlight> flights;
  FlightSurvey().Update(EvidenceOf(both), {}, {0, 0, 0}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 2u);
  EXPECT_NE(flights[0].id, flights[1].id);
}

TEST(FlightSurvey, AFlightThroughALevelIsTwo) {
  const StairEvidence evidence = EvidenceOf(FlightEvidence(20, 1, 28));
  std::vector<StairFlight> flights;
  const std::vector<double> levels_m = {0, 1.5};
  FlightSurvey().Update(evidence, levels_m, {0, 0, 0}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 2u);
  EXPECT_NEAR(flights[0].p_top_world.z(), 1.5, 0.11);
  EXPECT_NEAR(flights[1].p_foot_world.z(), 1.6, 0.11);
}

// The far side of a wide flight lies more than a metre from where the foot was put.
TEST(FlightSurvey, TheFarSideOfAWalkedFlightIsTheSameFlight) {
  auto wide = FlightEvidence(20, 1, 14);
  for (int y = 10; y < 30; y += 10) {
    const auto side = FlightEvidence(20, 1, 14, y);
    wide.insert(wide.end(), side.begin(), side.end());
  }
  const StairEvidence evidence = EvidenceOf(wide);
  std::vector<Vector3d> path;
  for (int i = 0; i <= 16; ++i) path.emplace_back(1.9 + 0.2 * i, 0.5, 0.1 * i);
  std::vector<StairFlight> flights;
  NoteWalk(path, evidence, kVoxel_m, &flights);
  FlightSurvey().Update(evidence, {}, {5, 0, 1.6}, kVoxel_m, &flights);
  EXPECT_EQ(flights.size(), 1u);
}

TEST(FlightSurvey, AWalkedFlightIsNotSurveyedAgain) {
  const StairEvidence evidence = EvidenceOf(FlightEvidence(20, 1, 14));
  std::vector<StairFlight> flights;
  FlightSurvey survey;
  survey.Update(evidence, {}, {0, 0, 0}, kVoxel_m, &flights);
  std::vector<Vector3d> path;
  for (int i = 0; i <= 16; ++i) path.emplace_back(1.9 + 0.2 * i, 0.5, 0.1 * i);
  NoteWalk(path, evidence, kVoxel_m, &flights);
  survey.Update(evidence, {}, {5, 0, 1.6}, kVoxel_m, &flights);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_TRUE(flights[0].IsWalked());
  EXPECT_EQ(flights[0].id, 0);
}

}  // namespace
}  // namespace crossnav::policy
