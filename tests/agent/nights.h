// SPDX-License-Identifier: MIT
// Worlds that agents wake up in with what an earlier agent knew.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "agent/two_rooms.h"
#include "crossnav/objects/object_book.h"

namespace crossnav::agent::testing {

inline const Box3 kMovedCouch = BoxOf(0.1, 0.1, 0, 1.0, 0.9, 0.8);  // in the first room

/// All that is kept over night.
struct Night {
  std::vector<geometry::MapBlock> blocks;
  std::vector<memory::MemoryRow> rows;
  std::vector<objects::ObjectRecord> objects;
};

inline Night NightAfter(const Agent& agent) {
  Night night;
  const WorldBytes bytes = BytesOf(agent);
  night.blocks = bytes.blocks;
  night.rows = bytes.rows;
  night.objects = agent.objects();
  return night;
}

/// The first day, at the end of which the couch was found.
inline Night FirstDay() {
  test::BoxWalker walker = TwoRooms();
  Agent agent(SmallConfig(), test::FakeSuite(CouchSight(kCouch)));
  EXPECT_TRUE(agent.SetGoal("couch").has_value());
  EXPECT_EQ(RunAgent(agent, walker, 300).last_action, Action::kStop);
  return NightAfter(agent);
}

inline void Wake(const Night& night, int day, Agent* agent) {
  geometry::MapConfig config = agent->config().map;
  const bool is_counted = std::any_of(night.blocks.begin(), night.blocks.end(),
                                      [](const auto& block) { return !block.counts.empty(); });
  config.clearing = is_counted ? "evidence" : "never";
  auto map = geometry::ImportBlocks(night.blocks, config);
  ASSERT_TRUE(map.has_value());
  memory::SemanticMemory memory(agent->config().fusion, agent->config().map.voxel_m);
  for (const memory::MemoryRow& row : night.rows) memory.AppendRow(row);
  ASSERT_TRUE(agent->Restore(std::move(*map), std::move(memory)).has_value());
  agent->RestoreObjects(night.objects, day);
}

inline Config ConfigOf(const std::string& mode) {
  Config config = SmallConfig();
  config.memory.mode = mode;
  return config;
}

/// The rooms with the couch elsewhere, or nowhere.
inline test::BoxWalker Rearranged(const Box3* couch) {
  test::BoxWalker walker = TwoRooms();
  walker.rooms.solids.pop_back();
  if (couch) walker.rooms.solids.push_back(*couch);
  return walker;
}

inline bool IsVisit(const std::string& step) {
  return step.find("\"visit\"") != std::string::npos;
}

}  // namespace crossnav::agent::testing
