// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_evidence.h"

#include <gtest/gtest.h>

#include "crossnav/policy/frontiers.h"
#include "support/flight_world.h"

namespace crossnav::policy {
namespace {

using geometry::EndRun;
using test::FlightWorld;
using test::MakeFlight;

/// A frame in which each voxel of `voxels` fills one pixel of a solid block of stair mask.
struct StairFrame {
  Image<float> probability;
  std::vector<EndRun> ends;
};

StairFrame FrameOf(const std::vector<VoxelKey>& voxels, float probability = 0.8F) {
  constexpr int kWidth = 32;
  const int rows = (static_cast<int>(voxels.size()) + kWidth - 1) / kWidth;
  StairFrame frame{Image<float>(kWidth, rows + 4, 0.0F), {}};
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    frame.probability.data[i] = probability;
    frame.ends.push_back({static_cast<std::int32_t>(i), 1, voxels[i]});
  }
  return frame;
}

void Show(StairEvidence& evidence, const FlightWorld& world, int step, float probability = 0.8F) {
  const StairFrame frame = FrameOf(world.flight, probability);
  evidence.Update(frame.probability, frame.ends, world.map, {}, step);
}

bool IsConfirmed(const StairEvidence& evidence, const VoxelKey& key) {
  return evidence.voxels().at(key).is_confirmed;
}

TEST(StairEvidence, ComponentsUnderEightyPixelsAreIgnored) {
  const FlightWorld world = MakeFlight();
  for (const std::size_t count : {79u, 80u}) {
    StairEvidence evidence;
    const StairFrame frame =
        FrameOf(std::vector<VoxelKey>(world.flight.begin(), world.flight.begin() + count));
    evidence.Update(frame.probability, frame.ends, world.map, {}, 0);
    EXPECT_EQ(evidence.voxels().size(), count < 80 ? 0u : 80u);
  }
}

TEST(StairEvidence, PiecesThatTouchAtACornerAreTwo) {
  const FlightWorld world = MakeFlight();
  Image<float> probability(40, 20, 0.0F);
  std::vector<EndRun> ends;
  for (int i = 0; i < 2; ++i)
    for (int v = 0; v < 8; ++v)
      for (int u = 0; u < 8; ++u) {  // two squares of 64, corner to corner
        probability.At(8 * i + u, 8 * i + v) = 0.9F;
        ends.push_back({(8 * i + v) * 40 + 8 * i + u, 1, world.flight[ends.size()]});
      }
  StairEvidence evidence;
  evidence.Update(probability, ends, world.map, {}, 0);
  EXPECT_TRUE(evidence.voxels().empty());
  probability.At(8, 7) = 0.9F;  // now they share an edge
  evidence.Update(probability, ends, world.map, {}, 1);
  EXPECT_EQ(evidence.voxels().size(), 128u);
}

TEST(StairEvidence, PixelsBelowTheThresholdAreNoStair) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  Show(evidence, world, 0, 0.24F);
  EXPECT_TRUE(evidence.voxels().empty());
  Show(evidence, world, 1, 0.25F);
  EXPECT_EQ(evidence.voxels().size(), world.flight.size());
}

TEST(StairEvidence, IsConfirmedByThreeOfTheLastTenFrames) {
  const FlightWorld world = MakeFlight();
  const VoxelKey key = world.flight[world.flight.size() / 2];
  const auto confirmed_after = [&](const std::vector<int>& steps) {
    StairEvidence evidence;
    for (const int step : steps) Show(evidence, world, step);
    return IsConfirmed(evidence, key);
  };
  EXPECT_FALSE(confirmed_after({0, 1}));
  EXPECT_TRUE(confirmed_after({0, 1, 2}));
  EXPECT_TRUE(confirmed_after({0, 5, 9}));
  EXPECT_FALSE(confirmed_after({0, 5, 10}));
  EXPECT_FALSE(confirmed_after({0, 40, 80, 120}));
  EXPECT_TRUE(confirmed_after({0, 40, 41, 42, 90}));  // once confirmed it stays so
}

TEST(StairEvidence, AFlatFloorIsNeverConfirmed) {
  std::set<VoxelKey> floor;
  for (int x = 0; x < 15; ++x)
    for (int y = 0; y < 15; ++y) floor.insert({x, y, -1});
  const VoxelMap map = test::MapOfEvidence(floor, {});
  const StairFrame frame = FrameOf({floor.begin(), floor.end()});
  StairEvidence evidence;
  for (int step = 0; step < 10; ++step)
    evidence.Update(frame.probability, frame.ends, map, {}, step);
  for (const auto& [key, voxel] : evidence.voxels()) {
    EXPECT_FALSE(voxel.is_confirmed);
    EXPECT_LT(voxel.geometry_score, 0.65);
  }
}

TEST(StairEvidence, RejectForgetsACylinderAndNamesIt) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  Show(evidence, world, 0);
  const std::size_t before = evidence.voxels().size();
  const Vector3d p(0.2, 0.5, 0.2);
  const auto rejected = evidence.Reject(p, 0.8, 0.1);
  EXPECT_FALSE(rejected.empty());
  EXPECT_EQ(evidence.voxels().size() + rejected.size(), before);
  for (const VoxelKey& key : rejected) EXPECT_LE((CenterOf(key, 0.1) - p).norm(), 0.8);
  for (const auto& [key, voxel] : evidence.voxels())
    EXPECT_GT((CenterOf(key, 0.1) - p).norm(), 0.8);
}

TEST(FlightsFrom, AFlightIsFoundFromBothOfItsEnds) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  for (int step = 0; step < 3; ++step) Show(evidence, world, step);
  const auto up = FlightsFrom(evidence, world.map, 0, +1);
  ASSERT_EQ(up.size(), 1u);
  EXPECT_TRUE(up[0].is_confirmed);
  EXPECT_LT(up[0].p_entrance_world.x(), 0.6);
  EXPECT_GT(up[0].p_ahead_world.x(), up[0].p_entrance_world.x());
  EXPECT_NEAR(up[0].probability, 0.8, 1e-6);
  const auto down = FlightsFrom(evidence, world.map, world.top_m, -1);
  ASSERT_EQ(down.size(), 1u);
  EXPECT_GT(down[0].p_entrance_world.x(), world.end_m - 0.8);
  EXPECT_LT(down[0].p_ahead_world.x(), down[0].p_entrance_world.x());
}

TEST(FlightsFrom, NothingLeadsOnFromItsFarEnds) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  for (int step = 0; step < 3; ++step) Show(evidence, world, step);
  EXPECT_TRUE(FlightsFrom(evidence, world.map, 0, -1).empty());
  EXPECT_TRUE(FlightsFrom(evidence, world.map, world.top_m, +1).empty());
}

TEST(AscentFrontiers, StandOnTheFloorInFrontOfTheFirstStep) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  for (int step = 0; step < 3; ++step) Show(evidence, world, step);
  const auto flights = FlightsFrom(evidence, world.map, 0, +1);
  const auto level = BandAround(0, {}, 0.1);
  const auto frontiers = AscentFrontiers(flights, world.map, level, {});
  ASSERT_EQ(frontiers.size(), 1u);
  EXPECT_EQ(frontiers[0].kind, CandidateKind::kAscentFrontier);
  EXPECT_TRUE(std::is_sorted(frontiers[0].standing.begin(), frontiers[0].standing.end()));
  int on_floor = 0;
  for (const VoxelKey& key : frontiers[0].standing) {
    const Vector3d p = CenterOf(key, 0.1);
    EXPECT_LE((p - flights[0].p_entrance_world).head<2>().norm(), 1.0);
    EXPECT_LE(p.x(), flights[0].p_entrance_world.x());
    EXPECT_EQ(world.map.StateAt(key), geometry::VoxelState::kTraversable);
    on_floor += p.x() < 0;
  }
  EXPECT_GT(on_floor, 10);
}

TEST(AscentFrontiers, AreNoneBeforeTheFlightIsConfirmed) {
  const FlightWorld world = MakeFlight();
  StairEvidence evidence;
  for (int step = 0; step < 2; ++step) Show(evidence, world, step);
  const auto flights = FlightsFrom(evidence, world.map, 0, +1);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_TRUE(AscentFrontiers(flights, world.map, BandAround(0, {}, 0.1), {}).empty());
}

}  // namespace
}  // namespace crossnav::policy
