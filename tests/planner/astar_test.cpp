// SPDX-License-Identifier: MIT
#include "crossnav/planner/astar.h"

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <queue>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "crossnav/core/rng.h"
#include "support/map_of_states.h"
#include "support/places.h"

namespace crossnav::planner {
namespace {

using geometry::FactsOf;
using geometry::VoxelState;
using test::AddGround;
using test::SetState;

/// Plain Dijkstra over explicit states, written from the supplement's text: the oracle.
struct World {
  std::map<VoxelKey, geometry::Voxel> voxels;

  VoxelMap Build() const {
    VoxelMap map;
    for (const auto& [key, voxel] : voxels) SetState(map, key, voxel.state, voxel.is_inflated);
    return map;
  }

  std::optional<double> Dijkstra(const VoxelKey& start, const VoxelKey& goal,
                                 bool allow_inflated) const {
    const auto goal_it = voxels.find(goal);
    if (goal_it == voxels.end() || !FactsOf(goal_it->second.state).is_targetable)
      return std::nullopt;
    std::map<VoxelKey, double> cost{{start, 0}};
    using Item = std::pair<double, VoxelKey>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    queue.push({0, start});
    while (!queue.empty()) {
      const auto [d, at] = queue.top();
      queue.pop();
      if (at == goal) return d;
      if (d > cost[at]) continue;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dz = -1; dz <= 1; ++dz) {
            const VoxelKey to{at.x + dx, at.y + dy, at.z + dz};
            const auto it = voxels.find(to);
            if (to == at || it == voxels.end() || !FactsOf(it->second.state).is_pathable) continue;
            double c = std::sqrt(dx * dx + dy * dy + dz * dz) + FactsOf(it->second.state).penalty;
            if (it->second.is_inflated) {
              if (!allow_inflated) continue;
              c *= 2;
            }
            if (!cost.contains(to) || d + c < cost[to] - 1e-12) {
              cost[to] = d + c;
              queue.push({d + c, to});
            }
          }
    }
    return std::nullopt;
  }
};

World RandomWorld(Rng& rng) {
  static constexpr VoxelState kKinds[] = {
      VoxelState::kTraversable, VoxelState::kTraversable,    VoxelState::kTraversableStair,
      VoxelState::kStair,       VoxelState::kStairExpanded,  VoxelState::kFakeStair,
      VoxelState::kOccupied,    VoxelState::kTraversableFake};
  World world;
  for (int x = -4; x < 5; ++x)
    for (int y = -4; y < 5; ++y)
      for (int z = -2; z < 2; ++z)
        if (rng.Chance(0.6)) world.voxels[{x, y, z}] = {kKinds[rng.Below(8)], rng.Chance(0.15)};
  world.voxels[{-4, -4, -2}] = {VoxelState::kTraversable, false};
  return world;
}

double PathCost(const VoxelMap& map, const Plan& plan, double inflated_factor) {
  double cost = 0;
  for (std::size_t i = 1; i < plan.path.size(); ++i) {
    const auto voxel = map.At(plan.path[i]);
    const double edge =
        VoxelDistance(plan.path[i - 1], plan.path[i]) + FactsOf(voxel.state).penalty;
    cost += voxel.is_inflated ? edge * inflated_factor : edge;
  }
  return cost;
}

TEST(FindPath, CostsEqualPlainDijkstraOnRandomMaps) {
  Rng rng(7);
  int found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const World world = RandomWorld(rng);
    const VoxelMap map = world.Build();
    const VoxelKey start{-4, -4, -2}, goal{4, 4, rng.Int(-2, 1)};
    for (const bool allow_inflated : {false, true}) {
      GraphRules rules;
      rules.allow_inflated = allow_inflated;
      const Plan plan = FindPath(map, start, std::vector{goal}, rules, {});
      const auto expected = world.Dijkstra(start, goal, allow_inflated);
      ASSERT_EQ(plan.found(), expected.has_value()) << "trial " << trial;
      if (!expected) continue;
      ++found;
      EXPECT_NEAR(plan.cost, *expected, 1e-9);
      EXPECT_NEAR(PathCost(map, plan, 2), plan.cost, 1e-9);
    }
  }
  EXPECT_GT(found, 20);
}

TEST(FindPath, SeveralGoalsGiveTheCheapestOfThem) {
  Rng rng(11);
  for (int trial = 0; trial < 20; ++trial) {
    const World world = RandomWorld(rng);
    const VoxelMap map = world.Build();
    const VoxelKey start{-4, -4, -2};
    std::vector<VoxelKey> goals;
    std::optional<double> best;
    for (int i = 0; i < 12; ++i) {
      goals.push_back({rng.Int(-4, 4), rng.Int(-4, 4), rng.Int(-2, 1)});
      const auto cost = world.Dijkstra(start, goals.back(), false);
      // The start itself is never refused; Dijkstra above says 0 for it too.
      if (cost && (!best || *cost < *best)) best = cost;
    }
    const Plan plan = FindPath(map, start, goals, {}, {});
    ASSERT_EQ(plan.found(), best.has_value());
    if (!best) continue;
    EXPECT_NEAR(plan.cost, *best, 1e-9);
    EXPECT_EQ(plan.path.back(), goals[plan.goal_index]);
  }
}

TEST(FindPath, MatchesTheGoldenVectors) {
  std::ifstream file(test::SharedPath("vectors/paths.json"));
  if (!file) GTEST_SKIP() << "no golden vectors beside the project";
  const auto golden = nlohmann::json::parse(file);
  std::map<std::string, VoxelState> states;
  for (int i = 0; i < geometry::kVoxelStateCount; ++i)
    states[std::string(geometry::kStateFacts[i].name)] = static_cast<VoxelState>(i);
  const auto key_of = [](const nlohmann::json& j) { return VoxelKey{j[0], j[1], j[2]}; };
  for (const auto& test_case : golden["cases"]) {
    VoxelMap map;
    for (const auto& s : test_case["states"]) SetState(map, key_of(s), states.at(s[3]));
    for (const auto& k : test_case["inflated"])
      SetState(map, key_of(k), map.StateAt(key_of(k)), true);
    for (const bool allow_inflated : {false, true}) {
      GraphRules rules;
      rules.allow_inflated = allow_inflated;
      const Plan plan = FindPath(map, key_of(test_case["start"]),
                                 std::vector{key_of(test_case["goal"])}, rules, {});
      const auto& expected = test_case[allow_inflated ? "cost_allowing_inflated" : "cost_strict"];
      ASSERT_EQ(plan.found(), !expected.is_null());
      if (!plan.found()) continue;
      EXPECT_NEAR(plan.cost, expected.get<double>(), 1e-5 * expected.get<double>());
    }
  }
}

TEST(FindPath, AnAgentInsideInflationMayLeaveItButNotEnterAnother) {
  VoxelMap map;
  for (int x = 0; x < 12; ++x) SetState(map, {x, 0, 0}, VoxelState::kTraversable, x < 3);
  EXPECT_TRUE(FindPath(map, {0, 0, 0}, std::vector{VoxelKey{11, 0, 0}}, {}, {}).found());
  SetState(map, {6, 0, 0}, VoxelState::kTraversable, true);
  EXPECT_EQ(FindPath(map, {0, 0, 0}, std::vector{VoxelKey{11, 0, 0}}, {}, {}).status,
            PlanStatus::kUnreachable);
}

TEST(FindPath, TheLevelBandKeepsBasicExploreOffTheSteps) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 5, 0);
  for (int step = 0; step < 6; ++step)
    AddGround(map, 10 + 3 * step, 0, 13 + 3 * step, 5, 2 + 2 * step);
  const std::vector<VoxelKey> upstairs{{26, 2, 13}};
  EXPECT_TRUE(FindPath(map, {1, 2, 1}, upstairs, {}, {}).found());
  GraphRules rules;
  rules.level = LevelBand{-1, 3};
  EXPECT_FALSE(FindPath(map, {1, 2, 1}, upstairs, rules, {}).found());
  EXPECT_TRUE(FindPath(map, {1, 2, 1}, std::vector{VoxelKey{8, 4, 1}}, rules, {}).found());
}

TEST(FindPath, TheStairGraphBridgesGapsButNotWalls) {
  VoxelMap map;
  // Treads seven voxels apart; between them air was seen, and nothing below it.
  for (int x = 0; x <= 14; ++x) SetState(map, {x, 0, x / 2}, VoxelState::kTraversableFake);
  for (const int x : {0, 7, 14}) SetState(map, {x, 0, x / 2}, VoxelState::kTraversableStair);
  const std::vector<VoxelKey> top{{14, 0, 7}};
  EXPECT_FALSE(FindPath(map, {0, 0, 0}, top, {}, {}).found());
  GraphRules rules;
  rules.kind = GraphKind::kStair;
  EXPECT_TRUE(FindPath(map, {0, 0, 0}, top, rules, {}).found());
  for (int y = -12; y <= 12; ++y)
    for (int z = -12; z <= 12; ++z) SetState(map, {10, y, z}, VoxelState::kOccupied);
  EXPECT_FALSE(FindPath(map, {0, 0, 0}, top, rules, {}).found());
}

TEST(FindPath, TheStartReachesOverTheBlindRingAroundTheFeetButNotThroughAWall) {
  VoxelMap map;
  SetState(map, {0, 0, 0}, VoxelState::kTraversable);
  for (int x = 3; x < 9; ++x) SetState(map, {x, 0, 0}, VoxelState::kTraversable);
  const std::vector<VoxelKey> goal{{8, 0, 0}};
  GraphRules rules;
  EXPECT_FALSE(FindPath(map, {0, 0, 0}, goal, rules, {}).found());
  rules.start_reach_vox = 4;
  EXPECT_NEAR(FindPath(map, {0, 0, 0}, goal, rules, {}).cost, 8, 1e-9);
  SetState(map, {2, 0, 0}, VoxelState::kOccupied);
  EXPECT_FALSE(FindPath(map, {0, 0, 0}, goal, rules, {}).found());
}

TEST(FindPath, SaysWhenItGaveUp) {
  VoxelMap map;
  AddGround(map, 0, 0, 40, 40, 0);
  PlannerConfig config;
  config.max_expansions = 10;
  EXPECT_EQ(FindPath(map, {0, 0, 1}, std::vector{VoxelKey{39, 39, 1}}, {}, config).status,
            PlanStatus::kGaveUp);
}

TEST(StartVoxel, IsTheAirAboveTheFeet) {
  VoxelMap map;
  AddGround(map, 0, 0, 10, 10, -1);  // a floor whose top is at height 0
  const auto start = StartVoxel(map, {0.55, 0.55, 0.0});
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->x, 5);
  EXPECT_EQ(start->y, 5);
  EXPECT_LE(start->z, 1);
  EXPECT_FALSE(StartVoxel(map, {5.0, 5.0, 0.0}).has_value());
}

}  // namespace
}  // namespace crossnav::planner
