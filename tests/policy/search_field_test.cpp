// SPDX-License-Identifier: MIT
#include "crossnav/policy/search_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;

constexpr double kVoxel_m = 0.1, kEye_m = 0.88;
constexpr VoxelKey kLo{0, 0, 0}, kHi{39, 39, 0};

/// A camera 0.9 m above the ground at (0.2, 2.0) that looks along x, tilted down by `down_rad`.
Observation CameraLookingAlongX(double down_rad, double depth_m) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(80, 80, M_PI / 2);
  obs.depth_m = DepthImage(80, 80, static_cast<float>(depth_m));
  Pose pose = Pose::Identity();
  const Vector3d ahead(std::cos(down_rad), 0, -std::sin(down_rad)), right(0, -1, 0);
  pose.linear().col(0) = right;
  pose.linear().col(1) = ahead.cross(right);
  pose.linear().col(2) = ahead;
  pose.translation() = Vector3d(0.2, 2.0, 0.9);
  obs.T_world_camera = pose;
  return obs;
}

/// Ground of 4 x 4 m seen by a camera that looks down on it, with a table of 0.8 x 0.8 m.
VoxelMap GroundWithATable() {
  VoxelMap map;
  Observation obs;
  obs.camera = IntrinsicsFromHfov(320, 320, M_PI / 2);
  obs.depth_m = DepthImage(320, 320, 0);
  Pose pose = Pose::Identity();
  pose.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks down
  pose.translation() = Vector3d(2, 2, 2.45);
  obs.T_world_camera = pose;
  for (int v = 0; v < 320; ++v)
    for (int u = 0; u < 320; ++u) {
      for (const double height_m : {0.75, -0.05}) {
        const double depth_m = 2.45 - height_m;
        const Vector3d p = pose * BackProjectPixel(obs.camera, u, v, depth_m);
        const bool is_table = p.x() > 2.4 && p.x() < 3.2 && p.y() > 1.6 && p.y() < 2.4;
        if (height_m > 0 && !is_table) continue;
        obs.depth_m.At(u, v) = static_cast<float>(depth_m);
        break;
      }
    }
  map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  map.UpdateStates();
  return map;
}

int CountTops(const SearchField& field) {
  int tops = 0;
  for (const auto& [cell, patch] : field.patches()) tops += patch.height_m > 0.25;
  return tops;
}

TEST(SearchField, GroundAndTopsOfFurnitureArePatches) {
  SearchField field;
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);
  EXPECT_GE(CountTops(field), 4);
  EXPECT_GE(static_cast<int>(field.patches().size()) - CountTops(field), 60);
  for (const auto& [cell, patch] : field.patches())
    if (patch.height_m > 0.25) {
      EXPECT_NEAR(patch.height_m, 0.8, 0.11);
      EXPECT_GT(patch.p_world.x(), 2.3);
      EXPECT_LT(patch.p_world.x(), 3.3);
    }
}

/// Regression: of a worktop as high as the camera the front edge alone is seen, two columns of it
/// beside a sink.
TEST(SearchField, TheEdgeOfAHighTopIsAPatch) {
  VoxelMap map;
  test::AddGround(map, 0, 0, 2, 1, 0);
  test::AddGround(map, 0, 0, 2, 1, 9);
  SearchField field;
  field.Update(map, 0.1, kEye_m, kLo, kHi);
  ASSERT_EQ(field.patches().size(), 1U) << "ground needs more";
  EXPECT_NEAR(field.patches().begin()->second.height_m, 0.9, 1e-6);
}

/// Regression: a chest of drawers higher than the camera, seen from its side, had a patch of three
/// columns, and the monitor on it no place to stand.
TEST(SearchField, ATopHigherThanTheCameraGoesOnBehindItsEdge) {
  const auto columns_of = [](int edge_z) {
    VoxelMap map;
    test::AddGround(map, 0, 4, 12, 8, 0);
    for (int y = 4; y < 8; ++y) {
      for (int z = 1; z <= edge_z; ++z) test::SetState(map, {4, y, z}, VoxelState::kOccupied);
      for (int x = 5; x < 12; ++x)  // its inside, and all below its top behind the edge
        for (int z = 0; z < edge_z; ++z) test::SetState(map, {x, y, z}, VoxelState::kUnknown);
    }
    SearchField field;
    field.Update(map, 0.1, kEye_m, kLo, kHi);
    int columns = 0;
    for (const auto& [cell, patch] : field.patches())
      if (patch.height_m > 0.25) columns += patch.columns;
    return columns;
  };
  EXPECT_EQ(columns_of(10), 4 + 4 * 3 + 4 * 4) << "edge, its cell and the cell behind it";
  EXPECT_EQ(columns_of(6), 4) << "a lower top shows from above: behind it is a shadow";
}

TEST(SearchField, APatchBehindASurfaceWasNotLookedAt) {
  SearchField field;
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);
  field.Look(CameraLookingAlongX(0.3, 1.0), 5);  // a wall a metre ahead
  int near = 0;
  for (const auto& [cell, patch] : field.patches()) {
    if (patch.p_world.x() > 1.8) {
      EXPECT_TRUE(std::isinf(patch.low.for_goal_m));
    }
    near += patch.low.for_goal_m < 5;
  }
  EXPECT_GT(near, 0);
}

/// Regression: a television at a thin wall counted as looked at from the next room.
TEST(SearchField, APatchAtTheBackOfAThinWallWasNotLookedAt) {
  VoxelMap map;
  test::AddGround(map, 16, 18, 20, 22, 0);
  SearchField field;
  field.Update(map, 0.1, kEye_m, kLo, kHi);
  ASSERT_FALSE(field.patches().empty());
  const policy::SearchPatch& patch = field.patches().begin()->second;
  const Observation obs = CameraLookingAlongX(0.3, 1);
  const double away_m = (obs.T_world_camera.inverse() * patch.LowPoint()).z();
  field.Look(CameraLookingAlongX(0.3, away_m - 0.15), 5);
  EXPECT_TRUE(std::isinf(patch.low.in_run_m));
  field.Look(CameraLookingAlongX(0.3, away_m + 0.01), 5);
  EXPECT_TRUE(std::isfinite(patch.low.in_run_m));
}

TEST(SearchField, TheNearestLookIsKeptAndAGoalBeginsAnew) {
  SearchField field;
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);
  field.Look(CameraLookingAlongX(0.3, 9), 3);
  int looked = 0;
  for (const auto& [cell, patch] : field.patches()) {
    if (!std::isfinite(patch.low.for_goal_m)) continue;
    ++looked;
    EXPECT_LE(patch.low.for_goal_m, 3);
    EXPECT_NEAR(patch.low.for_goal_m, (patch.LowPoint() - Vector3d(0.2, 2.0, 0.9)).norm(), 1e-4);
  }
  ASSERT_GT(looked, 10);
  field.BeginGoal();
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);  // the same map: looks of the run stay
  int in_run = 0;
  for (const auto& [cell, patch] : field.patches()) {
    EXPECT_TRUE(std::isinf(patch.low.for_goal_m));
    in_run += std::isfinite(patch.low.in_run_m);
  }
  EXPECT_EQ(in_run, looked);
}

/// Regression: where surfaces came and went with the map's evidence, an agent went to and fro
/// between two floors to look at them again.
TEST(SearchField, APatchThatTheMapLosesForAMomentWasLookedAt) {
  SearchField field;
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);
  field.Look(CameraLookingAlongX(0.3, 9), 3);
  const auto count = [&] {
    return std::count_if(field.patches().begin(), field.patches().end(), [](const auto& entry) {
      return std::isfinite(entry.second.low.in_run_m);
    });
  };
  const auto looked = count();
  ASSERT_GT(looked, 10);
  field.Update(VoxelMap(), 0, kEye_m, kLo, kHi);
  EXPECT_TRUE(field.patches().empty());
  field.BeginGoal();
  field.Update(GroundWithATable(), 0, kEye_m, kLo, kHi);
  EXPECT_EQ(count(), looked);
  for (const auto& [cell, patch] : field.patches()) EXPECT_TRUE(std::isinf(patch.low.for_goal_m));
}

}  // namespace
}  // namespace crossnav::policy
