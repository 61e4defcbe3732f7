// SPDX-License-Identifier: MIT
#include "crossnav/policy/stair_geometry.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "crossnav/core/rng.h"
#include "support/flight_world.h"
#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using test::FlightSize;
using test::MakeFlight;

constexpr double kThreshold = 0.65;  // tab:supp_configuration

double ScoreOf(std::set<VoxelKey> surface) {
  const VoxelMap map = test::MapOfEvidence(surface, {});
  return ScoreStairGeometry(map, std::vector<VoxelKey>(surface.begin(), surface.end())).Score();
}

TEST(ScoreStairGeometry, OrdinaryFlightsPass) {
  for (const auto& [riser_m, tread_m] :
       {std::pair{0.175, 0.28}, {0.15, 0.30}, {0.19, 0.25}, {0.20, 0.23}}) {
    const auto world = MakeFlight({.steps = 12, .riser_m = riser_m, .tread_m = tread_m});
    EXPECT_GE(ScoreStairGeometry(world.map, world.flight).Score(), kThreshold)
        << riser_m << " / " << tread_m;
  }
}

TEST(ScoreStairGeometry, EveryCueOfAnOrdinaryFlightIsHigh) {
  const auto world = MakeFlight();
  const StairGeometry score = ScoreStairGeometry(world.map, world.flight);
  EXPECT_GT(score.height_variation, 0.9);
  EXPECT_GT(score.step_trend, 0.8);
  EXPECT_EQ(score.continuity, 1);
  EXPECT_EQ(score.head_room, 1);
}

TEST(ScoreStairGeometry, AFlatFloorFails) {
  std::set<VoxelKey> floor;
  for (int x = 0; x < 15; ++x)
    for (int y = 0; y < 15; ++y) floor.insert({x, y, 0});
  EXPECT_LT(ScoreOf(floor), kThreshold);
}

TEST(ScoreStairGeometry, AWallFails) {
  std::set<VoxelKey> wall;
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 24; ++z) wall.insert({0, y, z});
  EXPECT_LT(ScoreOf(wall), kThreshold);
}

TEST(ScoreStairGeometry, NothingAndCrumbsScoreZero) {
  EXPECT_EQ(ScoreOf({}), 0);
  EXPECT_EQ(ScoreOf({{0, 0, 0}, {1, 0, 2}, {2, 0, 4}, {3, 0, 6}, {4, 0, 8}}), 0);
}

TEST(ScoreStairGeometry, ScatteredPiecesLoseContinuity) {
  const auto world = MakeFlight();
  std::vector<VoxelKey> voxels = world.flight;
  for (const VoxelKey& key : world.flight) voxels.push_back({key.x, key.y + 200, key.z});
  std::sort(voxels.begin(), voxels.end());
  EXPECT_NEAR(ScoreStairGeometry(world.map, voxels).continuity, 0.5, 1e-9);
}

TEST(ScoreStairGeometry, ALowCeilingLosesHeadRoom) {
  const auto world = MakeFlight();
  VoxelMap map = MakeFlight().map;
  for (const VoxelKey& key : world.flight)
    test::SetState(map, {key.x, key.y, key.z + 10}, geometry::VoxelState::kOccupied);
  EXPECT_EQ(ScoreStairGeometry(map, world.flight).head_room, 0);
}

TEST(ColumnTops, AreTheHighestOfEachColumn) {
  EXPECT_EQ(ColumnTops({{0, 0, 1}, {0, 0, 4}, {0, 1, 2}, {1, 0, 0}, {1, 0, 3}}),
            (std::vector<VoxelKey>{{0, 0, 4}, {0, 1, 2}, {1, 0, 3}}));
  EXPECT_TRUE(ColumnTops({}).empty());
}

TEST(FitPlane, FindsPlanesThatGoThroughTheCentres) {
  for (int a = -2; a <= 2; ++a)
    for (int b = -2; b <= 2; ++b) {
      std::vector<VoxelKey> voxels;
      for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 6; ++y) voxels.push_back({x, y, a * x + b * y + 3});
      const PlaneFit fit = FitPlane(voxels, 0.1);
      EXPECT_NEAR(fit.gradient.x(), a, 1e-6);
      EXPECT_NEAR(fit.gradient.y(), b, 1e-6);
      EXPECT_NEAR(fit.residual_m, 0, 1e-6);
      EXPECT_EQ(fit.count, 48);
    }
}

TEST(FitPlane, EqualsLeastSquaresByQrOnRandomVoxels) {
  Rng rng(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<VoxelKey> voxels;
    const int count = rng.Int(6, 80);
    for (int i = 0; i < count; ++i)
      voxels.push_back({rng.Int(-10, 10), rng.Int(-10, 10), rng.Int(-10, 10)});
    Eigen::MatrixXd A(count, 3);
    Eigen::VectorXd z(count);
    for (int i = 0; i < count; ++i) {
      const VoxelKey& k = voxels[static_cast<std::size_t>(i)];
      A.row(i) << 0.1 * (k.x + 0.5), 0.1 * (k.y + 0.5), 1;
      z[i] = 0.1 * (k.z + 0.5);
    }
    const Eigen::Vector3d solution = A.colPivHouseholderQr().solve(z);
    const PlaneFit fit = FitPlane(voxels, 0.1);
    EXPECT_TRUE(fit.gradient.isApprox(solution.head<2>(), 1e-5)) << "trial " << trial;
    EXPECT_NEAR(fit.residual_m, std::sqrt((A * solution - z).squaredNorm() / count), 1e-6);
  }
}

TEST(IsFlatAround, HoldsOnFloorsAndNotOnFlights) {
  for (const auto& [riser_m, tread_m] :
       {std::pair{0.175, 0.28}, {0.15, 0.30}, {0.19, 0.25}, {0.20, 0.23}}) {
    const auto world = MakeFlight({.steps = 12, .riser_m = riser_m, .tread_m = tread_m});
    for (double x = -1.4; x < -0.6; x += 0.1)
      EXPECT_TRUE(IsFlatAround(world.map, {x, 0.5, 0})) << riser_m << " at " << x;
    for (double x = world.end_m + 0.6; x < world.end_m + 1.4; x += 0.1)
      EXPECT_TRUE(IsFlatAround(world.map, {x, 0.5, world.top_m})) << riser_m << " at " << x;
    for (int step = 3; step < 10; ++step) {
      const Vector3d p((step - 0.5) * tread_m, 0.5, step * riser_m);
      EXPECT_FALSE(IsFlatAround(world.map, p)) << riser_m << " on step " << step;
    }
  }
}

TEST(IsFlatAround, AWallBesideTheFloorDoesNotTiltIt) {
  VoxelMap map;
  test::AddGround(map, 0, 0, 20, 20, -1);
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 20; ++z) test::SetState(map, {13, y, z}, geometry::VoxelState::kOccupied);
  EXPECT_TRUE(IsFlatAround(map, {1.05, 1.05, 0}));
}

TEST(IsFlatAround, UnseenGroundIsNotFlat) {
  EXPECT_FALSE(IsFlatAround(VoxelMap(), {0, 0, 0}));
}

}  // namespace
}  // namespace crossnav::policy
