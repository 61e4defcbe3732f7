// SPDX-License-Identifier: MIT
// Each row of the paper's frozen configuration (tab:supp_configuration) against the defaults.
#include <gtest/gtest.h>

#include "crossnav/bench/run_config.h"
#include "crossnav/core/categories.h"
#include "crossnav/geometry/voxel_states.h"

namespace crossnav::bench {
namespace {

const RunConfig kConfig;

TEST(ConfigPaperTable, SensorAndActions) {
  EXPECT_EQ(kConfig.agent.sensor.width_px, 640);
  EXPECT_EQ(kConfig.agent.sensor.height_px, 640);
  EXPECT_EQ(kConfig.agent.sensor.hfov_deg, 90);
  EXPECT_EQ(kConfig.agent.sensor.camera_height_m, 0.88);
  EXPECT_EQ(kConfig.agent.action.forward_m, 0.25);
  EXPECT_EQ(kConfig.agent.action.turn_deg, 30);
  EXPECT_EQ(kConfig.agent.action.pitch_deg, 30);
}

TEST(ConfigPaperTable, Map) {
  EXPECT_EQ(kConfig.agent.map.extent_xy_m, 60);
  EXPECT_EQ(kConfig.agent.map.extent_z_m, 60);
  EXPECT_EQ(kConfig.agent.map.voxel_m, 0.10);
  EXPECT_EQ(kConfig.agent.map.inflation_m, 0.20);
  EXPECT_EQ(kConfig.agent.map.support_depth_m, 0.40);
}

TEST(ConfigPaperTable, EncoderOutput) {
  EXPECT_EQ(kConfig.ground_truth.feature_rows, 24);
  EXPECT_EQ(kConfig.ground_truth.feature_cols, 24);
  EXPECT_EQ(kConfig.ground_truth.feature_dim, 768);
}

TEST(ConfigPaperTable, FusionAndRetrieval) {
  EXPECT_EQ(kConfig.agent.fusion.gamma, 0.20);
  EXPECT_EQ(kConfig.agent.fusion.preferred_depth_m, 1.0);
  EXPECT_EQ(kConfig.agent.fusion.depth_scale_m, 1.5);
  EXPECT_EQ(kConfig.agent.query.top_k, 4);
  EXPECT_EQ(kConfig.agent.policy.poi.blacklist_xy_m, 0.8);
  EXPECT_EQ(kConfig.agent.policy.poi.blacklist_z_m, 0.6);
  EXPECT_EQ(kConfig.agent.policy.poi.live_takeover_m, 1.0);
}

TEST(ConfigPaperTable, ObjectAndApproach) {
  EXPECT_EQ(kConfig.agent.policy.object.detector_confidence, 0.70);
  EXPECT_EQ(kConfig.agent.policy.object.secondary_confidence, 0.60);
  EXPECT_EQ(kConfig.agent.policy.object.found_confidence, 0.70);
  EXPECT_EQ(kConfig.agent.policy.object.min_box_area_fraction, 1.0 / 64);
  EXPECT_EQ(kConfig.agent.policy.object.min_projected_voxels, 10);
  EXPECT_EQ(kConfig.agent.policy.approach.range_m, 1.30);
}

TEST(ConfigPaperTable, StairsAndFrontiers) {
  EXPECT_EQ(kConfig.agent.policy.stair.pixel_threshold, 0.25);
  EXPECT_EQ(kConfig.agent.policy.stair.min_component_px, 80);
  EXPECT_EQ(kConfig.agent.policy.stair.descent_confirmation, 0.48);
  EXPECT_EQ(kConfig.agent.policy.stair.geometry_threshold, 0.65);
  EXPECT_EQ(kConfig.agent.policy.stair.admission_radius_m, 2.5);
  EXPECT_EQ(kConfig.agent.policy.stair.arrival_m, 0.40);
  EXPECT_EQ(kConfig.agent.policy.frontier.min_cluster, 5);
  EXPECT_EQ(kConfig.agent.policy.frontier.min_cluster_init_descent, 2);
}

TEST(ConfigPaperTable, Planner) {
  using geometry::FactsOf;
  using geometry::VoxelState;
  EXPECT_EQ(kConfig.agent.planner.stair_edge_radius_m, 1.0);
  EXPECT_EQ(kConfig.agent.planner.inflated_cost_factor, 2);
  EXPECT_EQ(FactsOf(VoxelState::kTraversable).penalty, 0);
  EXPECT_EQ(FactsOf(VoxelState::kTraversableStair).penalty, 0);
  EXPECT_EQ(FactsOf(VoxelState::kStair).penalty, 4);
  EXPECT_EQ(FactsOf(VoxelState::kStairExpanded).penalty, 5);
  EXPECT_EQ(FactsOf(VoxelState::kFakeStair).penalty, 10);
}

TEST(ConfigPaperTable, NavMesh) {
  EXPECT_EQ(kConfig.navmesh.agent_height_m, 1.50);
  EXPECT_EQ(kConfig.navmesh.agent_radius_m, 0.10);
  EXPECT_EQ(kConfig.navmesh.max_climb_m, 0.30);
  EXPECT_EQ(kConfig.navmesh.max_slope_deg, 60);
  EXPECT_EQ(kConfig.navmesh.cell_m, 0.03);
  EXPECT_EQ(kConfig.navmesh.cell_height_m, 0.05);
}

TEST(ConfigPaperTable, EvaluationAndDataset) {
  EXPECT_EQ(kConfig.eval.action_budget, 1200);
  EXPECT_EQ(kConfig.eval.success_radius_m, 1.50);
  EXPECT_EQ(kConfig.dataset.goals, 3);
  EXPECT_EQ(kCategories.size(), 6u);
}

}  // namespace
}  // namespace crossnav::bench
