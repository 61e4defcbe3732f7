// SPDX-License-Identifier: MIT
// Each row of the paper's frozen configuration (tab:supp_configuration) by the effect of the
// defaults: behaviour changes at the value of the table. The agent's half; the simulator's, the
// evaluator's and the navmesh's are in config_paper_world_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/agent/paper_behaviour.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/observation_quality.h"
#include "crossnav/memory/row_kernels.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/clusters.h"
#include "crossnav/policy/frontiers.h"
#include "crossnav/policy/stair_geometry.h"
#include "crossnav/policy/steering.h"
#include "crossnav/policy/takeover.h"
#include "support/flight_world.h"
#include "support/map_of_states.h"
#include "support/sightings.h"

namespace crossnav::evaluation {
namespace {

using crossnav::test::AddGround;
using crossnav::test::MakeFlight;
using crossnav::test::SetState;
using geometry::VoxelKey;
using geometry::VoxelState;

const RunConfig kConfig;
const agent::Config& kAgent = kConfig.agent;

TEST(ConfigPaperTable, Sensor) {
  const CameraIntrinsics camera = kAgent.sensor.Intrinsics();
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 640);
  // The image's edge, half a pixel beyond the first pixel's centre, is seen at 45 degrees.
  EXPECT_NEAR(BackProjectPixel(camera, -0.5, 319.5, 1).x(), -1, 1e-12);
  Observation obs;
  obs.T_world_camera = CameraPose({}, kAgent.sensor.camera_height_m);
  EXPECT_NEAR(obs.T_world_camera.translation().z(), 0.88, 1e-12);
}

// One turn or pitch action serves targets at angles of half to one and a half actions.
TEST(ConfigPaperTable, YawAndPitchIncrement) {
  const auto turn_to = [](double yaw_deg) {
    const Vector3d p(std::cos(DegToRad(yaw_deg)), std::sin(DegToRad(yaw_deg)), 0.88);
    return policy::CenteringAction({}, p, 0.88, kAgent.action);
  };
  EXPECT_FALSE(turn_to(14.9));
  EXPECT_EQ(turn_to(15.1), Action::kTurnLeft);
  EXPECT_FALSE(policy::PitchTowards({}, DegToRad(-14.9), kAgent.action));
  EXPECT_EQ(policy::PitchTowards({}, DegToRad(-15.1), kAgent.action), Action::kLookDown);
}

/// Floor over 30 x 30 columns at z = -1, and a wall at x = 15.
geometry::VoxelMap FloorAndWall() {
  std::set<VoxelKey> surface, free;
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y) {
      surface.insert({x, y, -1});
      for (int z = 0; z < 18; ++z) (x == 15 ? surface : free).insert({x, y, z});
    }
  const auto blocks = ExportBlocks(crossnav::test::MapOfEvidence(surface, free));
  auto map = std::move(*geometry::ImportBlocks(blocks, kAgent.map));
  map.UpdateStates();
  return map;
}

TEST(ConfigPaperTable, VoxelsSupportAndInflation) {
  EXPECT_EQ(geometry::KeyOf({0.099, 0.101, -0.001}, kAgent.map.voxel_m), (VoxelKey{0, 1, -1}));
  const auto map = FloorAndWall();
  EXPECT_EQ(map.StateAt({5, 5, 3}), VoxelState::kTraversable);      // 0.40 m above the support
  EXPECT_EQ(map.StateAt({5, 5, 4}), VoxelState::kTraversableFake);  // 0.50 m
  EXPECT_TRUE(map.At({13, 15, 0}).is_inflated);                     // 0.20 m from the wall
  EXPECT_FALSE(map.At({12, 15, 0}).is_inflated);                    // 0.30 m
}

TEST(ConfigPaperTable, ExtentOfThePapersMap) {
  geometry::MapConfig config = kAgent.map;
  config.clip_to_extent = true;  // as policy.profile = paper has it
  geometry::VoxelMap map(config);
  const CameraIntrinsics camera = IntrinsicsFromHfov(16, 16, DegToRad(30));
  for (const AgentPose& pose :
       {AgentPose{}, AgentPose{{27.05, 0, 0}, 0, 0}, AgentPose{{-27.05, 0, 0}, DegToRad(180), 0}})
    map.Integrate(DepthImage(16, 16, 8.0F), camera, CameraPose(pose, 0.85));
  map.UpdateStates();
  int lo = 0, hi = 0;
  map.ForEach([&](const VoxelKey& key, const geometry::Voxel&) {
    lo = std::min(lo, key.x);
    hi = std::max(hi, key.x);
  });
  EXPECT_EQ(hi - lo + 1, 600);
  EXPECT_EQ(geometry::VoxelMap(config).config().extent_z_m, 60);
}

/// Weight of the middle pixel of a plane whose depth grows by `slope` metres a pixel.
double WeightAt(double depth_m, double slope) {
  const CameraIntrinsics camera = kAgent.sensor.Intrinsics();
  DepthImage depth(camera.width_px, 3);
  for (int v = 0; v < 3; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.At(u, v) = static_cast<float>(depth_m + slope * (u - 320));
  memory::QualityRows rows;
  CameraIntrinsics rows_camera = camera;
  rows_camera.height_px = 3;
  rows.Reset(depth, rows_camera, kAgent.fusion);
  return rows.Row(1)[320];
}

TEST(ConfigPaperTable, Fusion) {
  EXPECT_NEAR(WeightAt(1.0, 0), 1, 1e-4);                               // d0
  EXPECT_NEAR(WeightAt(1.0 + 1.5 * std::sqrt(3.0), 0), 1 / M_E, 1e-3);  // sigma
  // At the table's 640 px the gradient is scaled by W / fx = 2: gamma x 2 x 1 m a pixel.
  const double slope = 1e-3;
  EXPECT_NEAR((1 - WeightAt(1.0, slope)) / slope, 0.20 * 2, 0.02);
}

TEST(ConfigPaperTable, TopFourClusters) {
  memory::SemanticMemory memory(kAgent.fusion, 0.1);
  Rng rng(5);
  const auto put = [&](const VoxelKey& key, float share) {
    std::vector<float> f(16);
    for (float& x : f) x = static_cast<float>(0.05 * rng.Normal());
    f[0] += share;
    f[1] += 1;
    memory::MemoryRow row{key, 1.0f, 1.0f, Vector3f::Zero(), std::vector<std::uint16_t>(16)};
    memory::ToHalf(f, row.half.data());
    memory.AppendRow(row);
  };
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 60; ++y) put({x, y, 0}, 0);
  for (int blob = 0; blob < 6; ++blob)
    for (int i = 0; i < 27; ++i) put({10 * blob + i % 3, 10 + i / 3 % 3, 10 + i / 9}, 3);
  std::vector<float> text(16);
  text[0] = 1;
  EXPECT_EQ(memory::Query(memory, text, kAgent.query).size(), 4u);
}

TEST(ConfigPaperTable, BlacklistCylinderAndLiveTakeover) {
  const policy::PoiConfig& poi = kAgent.policy.poi;
  const auto is_hit = [&](const Vector3d& p) {
    return policy::IsBlacklisted({{Vector3d::Zero(), poi.blacklist_xy_m, poi.blacklist_z_m}}, p);
  };
  EXPECT_TRUE(is_hit({0.79, 0, 0.59}));
  EXPECT_FALSE(is_hit({0.81, 0, 0}));
  EXPECT_FALSE(is_hit({0, 0, 0.61}));
  EXPECT_TRUE(policy::IsTakeover({0.99, 0, 0}, Vector3d::Zero(), poi));
  EXPECT_FALSE(policy::IsTakeover({1.01, 0, 0}, Vector3d::Zero(), poi));
}

std::vector<VoxelKey> Block(int x, int count) {
  std::vector<VoxelKey> keys;
  for (int i = 0; i < count; ++i) keys.push_back({x + i / 9, i % 3, 8 + i / 3 % 3});
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(ConfigPaperTable, DetectorConfidenceAndBoxArea) {
  const auto counts = [](double confidence, double area) {
    policy::LivePois pois;
    pois.Update({crossnav::test::SightingOf(Block(0, 27), confidence, area)}, kAgent.policy.object,
                0.1, 0);
    return pois.all().size();
  };
  EXPECT_EQ(counts(0.70, 0.1), 1u);
  EXPECT_EQ(counts(0.69, 0.1), 0u);
  EXPECT_EQ(counts(0.9, 1.0 / 64), 1u);
  EXPECT_EQ(counts(0.9, 0.99 / 64), 0u);
}

TEST(ConfigPaperTable, SecondaryConfidence) {
  for (const double confidence : {0.59, 0.60}) {
    policy::LivePois pois;
    const auto& object = kAgent.policy.object;
    pois.Update({crossnav::test::SightingOf(Block(0, 27), 0.9, 0.1)}, object, 0.1, 0);
    const int id = pois.all().front().id;
    pois.Update({crossnav::test::SightingOf(Block(1, 27), confidence, 0.1)}, object, 0.1, 1, id);
    EXPECT_EQ(pois.all().front().frames, confidence < 0.6 ? 1 : 2);
  }
}

TEST(ConfigPaperTable, MinimumProjectedVoxels) {
  for (const int columns : {9, 10}) {
    Observation obs;
    obs.camera = IntrinsicsFromHfov(100, 100, DegToRad(90));
    obs.depth_m = DepthImage(100, 100, 5.0F);  // a pixel is a voxel wide
    obs.T_world_camera = CameraPose({}, 0.85);
    perception::Detection detection;
    detection.box = {50, 50, 50 + columns, 51};
    detection.confidence = 0.9F;
    detection.mask = MaskImage(100, 100, 1);
    const auto found =
        policy::LiftDetections({detection}, obs, kAgent.map, kAgent.policy.object, 0.6);
    EXPECT_EQ(found.size(), columns < 10 ? 0u : 1u);
  }
}

policy::Verification VerifyAt(double confidence, double distance_m) {
  policy::LivePoi poi;
  poi.voxels = Block(9, 9);
  poi.p_center_world = policy::CentroidOf(poi.voxels, 0.1);
  Observation obs;
  obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  obs.depth_m = DepthImage(64, 64, 3.0F);
  AgentPose agent;
  agent.p_world = {0.95 - distance_m, 0.15, 0};
  obs.T_world_camera = CameraPose(agent, 0.88);
  return policy::Verify(poi, {crossnav::test::SightingOf(poi.voxels, confidence, 0.1)},
                        {obs, agent, 0.88}, kAgent.policy, 0.1);
}

TEST(ConfigPaperTable, FoundConfidenceAndTargetApproachRange) {
  EXPECT_TRUE(VerifyAt(0.70, 1.29).passed) << VerifyAt(0.70, 1.29).failed_check;
  EXPECT_EQ(VerifyAt(0.69, 1.29).failed_check, "confidence");
  EXPECT_EQ(VerifyAt(0.70, 1.31).failed_check, "distance");
}

TEST(ConfigPaperTable, StairPixelsAndComponents) {
  const auto flight = MakeFlight();
  const auto lifted = [&](float probability, int count) {
    Image<float> mask(32, 8, 0.0F);
    std::vector<geometry::EndRun> ends;
    for (int i = 0; i < count; ++i) {
      mask.data[static_cast<std::size_t>(i)] = probability;
      ends.push_back({i, 1, flight.flight[static_cast<std::size_t>(i)]});
    }
    policy::StairEvidence evidence;
    evidence.Update(mask, ends, flight.map, kAgent.policy.stair, 0);
    return static_cast<int>(evidence.voxels().size());
  };
  EXPECT_EQ(lifted(0.25F, 80), 80);
  EXPECT_EQ(lifted(0.24F, 80), 0);
  EXPECT_EQ(lifted(0.25F, 79), 0);
}

/// Treads of a flight that a session of `direction` promotes, whose evidence has these scores.
int PromotedTreads(int direction, float probability, float geometry_score) {
  auto world = MakeFlight({.steps = 6});
  policy::StairEvidence evidence;
  std::vector<geometry::SeenStair> seen;
  for (const VoxelKey& key : world.flight) seen.push_back({key, probability, geometry_score, true});
  evidence.Import(seen);
  const double level_m = direction > 0 ? 0 : world.top_m;
  auto session = policy::BeginSession(direction, level_m, {0, 0.5, 0}, world.flight);
  policy::PromoteStairs(session, evidence, world.map, kAgent.policy.stair);
  const auto treads = policy::ColumnTops(world.flight);
  return static_cast<int>(std::count_if(treads.begin(), treads.end(), [&](const VoxelKey& key) {
    return world.map.StairMarkAt(key) == geometry::StairMark::kStair;
  }));
}

TEST(ConfigPaperTable, GeometryThresholdAndDescentConfirmation) {
  EXPECT_GT(PromotedTreads(+1, 0.9F, 0.651F), 50);
  EXPECT_EQ(PromotedTreads(+1, 0.9F, 0.649F), 0);
  EXPECT_GT(PromotedTreads(-1, 0.481F, 0.481F), 50);
  EXPECT_EQ(PromotedTreads(-1, 0.479F, 0.479F), 0);
}

TEST(ConfigPaperTable, SessionAdmissionRadius) {
  auto world = MakeFlight({.steps = 20});
  policy::StairEvidence evidence;
  std::vector<geometry::SeenStair> seen;
  for (const VoxelKey& key : world.flight) seen.push_back({key, 0.9F, 0.9F, true});
  evidence.Import(seen);
  const auto treads = policy::ColumnTops(world.flight);
  auto session = policy::BeginSession(+1, 0, {0, 0.5, 0}, {treads.front()});
  policy::PromoteStairs(session, evidence, world.map, kAgent.policy.stair);
  double farthest_m = 0;
  for (const VoxelKey& key : treads)
    if (world.map.StairMarkAt(key) == geometry::StairMark::kStair)
      farthest_m = std::max(farthest_m, 0.1 * VoxelDistance(key, treads.front()));
  EXPECT_LE(farthest_m, 2.5 + 1e-9);
  EXPECT_GT(farthest_m, 2.4);
}

// At a descend frontier: nearer than the arrival threshold the agent verifies, farther off it
// walks.
TEST(ConfigPaperTable, ArrivalThreshold) {
  for (const double distance_m : {0.39, 0.41}) {
    agent::World world(kAgent);
    AddGround(world.map, 0, 0, 30, 10, -1);
    agent::GoalState goal;
    AgentPose pose;
    pose.p_world = {1.05 - distance_m, 0.55, 0};
    agent::paper::Situation now{kAgent, world, goal, pose, pose, VoxelKey{6, 5, 0}, nullptr};
    agent::paper::Target target;
    target.candidate.kind = policy::CandidateKind::kDescendFrontier;
    target.candidate.standing = {{10, 5, 0}};
    target.plan.path = {{6, 5, 0}, {10, 5, 0}};
    goal.paper.commitment.emplace();
    agent::paper::Explore(now, target);
    EXPECT_EQ(goal.events.size() == 1 && goal.events[0] == "at a stair entrance", distance_m < 0.4);
  }
}

/// Frontiers of a strip of ground that borders on unknown, or unsupported, air in `width` columns.
std::size_t FrontiersOf(int width, VoxelState beyond, int step) {
  agent::Config config = kAgent;
  config.policy.profile = "paper";
  agent::World world(config);
  world.step = step;
  AddGround(world.map, 0, 0, 10, 10, -1);
  for (int z = -1; z <= 15; ++z)
    for (int i = -1; i <= 10; ++i) {
      for (const int edge : {-1, 10}) SetState(world.map, {i, edge, z}, VoxelState::kOccupied);
      SetState(world.map, {-1, i, z}, VoxelState::kOccupied);
      if (i >= width) SetState(world.map, {10, i, z}, VoxelState::kOccupied);
      if (i >= 0 && i < width && beyond != VoxelState::kUnknown)
        SetState(world.map, {10, i, z}, beyond);
    }
  agent::GoalState goal;
  const agent::paper::Situation now{config, world, goal, {}, {}, VoxelKey{5, 5, 0}, nullptr};
  return beyond == VoxelState::kUnknown ? agent::paper::OpenFrontiers(now).size()
                                        : agent::paper::OpenEntrances(now, 0, true).size();
}

TEST(ConfigPaperTable, MinimumClusters) {
  EXPECT_EQ(FrontiersOf(4, VoxelState::kUnknown, 100), 0u);
  EXPECT_EQ(FrontiersOf(5, VoxelState::kUnknown, 100), 1u);
  EXPECT_EQ(FrontiersOf(1, VoxelState::kUnknown, 0), 0u);
  EXPECT_EQ(FrontiersOf(2, VoxelState::kUnknown, 0), 1u);
  EXPECT_EQ(FrontiersOf(1, VoxelState::kTraversableFake, 100), 0u);
  EXPECT_EQ(FrontiersOf(2, VoxelState::kTraversableFake, 100), 1u);
}

double CostOf(const geometry::VoxelMap& map, const VoxelKey& to,
              planner::GraphKind kind = planner::GraphKind::kNormal, bool allow_inflated = false) {
  planner::GraphRules rules;
  rules.kind = kind;
  rules.allow_inflated = allow_inflated;
  const auto plan = planner::FindPath(map, {0, 0, 0}, std::vector{to}, rules, kAgent.planner);
  return plan.found() ? plan.cost : -1;
}

TEST(ConfigPaperTable, Planner) {
  geometry::VoxelMap map;
  SetState(map, {0, 0, 0}, VoxelState::kTraversable);
  SetState(map, {1, 1, 1}, VoxelState::kTraversable);
  EXPECT_NEAR(CostOf(map, {1, 1, 1}), std::sqrt(3.0), 1e-12);  // 26 neighbours
  SetState(map, {3, 0, 0}, VoxelState::kTraversable);
  EXPECT_EQ(CostOf(map, {3, 0, 0}), -1);
  SetState(map, {1, 1, 1}, VoxelState::kTraversable, true);
  EXPECT_NEAR(CostOf(map, {1, 1, 1}, planner::GraphKind::kNormal, true), 2 * std::sqrt(3.0), 1e-12);
  // tab:supp_astar_penalties, on the path to the goal behind
  const std::pair<VoxelState, double> penalties[] = {{VoxelState::kTraversable, 0},
                                                     {VoxelState::kTraversableStair, 0},
                                                     {VoxelState::kStair, 4},
                                                     {VoxelState::kStairExpanded, 5},
                                                     {VoxelState::kFakeStair, 10}};
  for (const auto& [state, penalty] : penalties) {
    geometry::VoxelMap row;
    for (const int x : {0, 2}) SetState(row, {x, 0, 0}, VoxelState::kTraversable);
    SetState(row, {1, 0, 0}, state);
    EXPECT_NEAR(CostOf(row, {2, 0, 0}), 2 + penalty, 1e-12);
  }
}

TEST(ConfigPaperTable, StairEdgeRadius) {
  for (const int gap : {10, 11}) {
    geometry::VoxelMap map;
    for (int x = 0; x <= gap; ++x) SetState(map, {x, 0, 0}, VoxelState::kTraversableFake);
    for (const int x : {0, gap}) SetState(map, {x, 0, 0}, VoxelState::kTraversableStair);
    EXPECT_EQ(CostOf(map, {gap, 0, 0}, planner::GraphKind::kStair) > 0, gap == 10);
  }
}

}  // namespace
}  // namespace crossnav::evaluation
