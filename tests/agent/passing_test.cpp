// SPDX-License-Identifier: MIT
// Things that are met on the way to other goals.
#include <gtest/gtest.h>

#include <algorithm>

#include "agent/nights.h"
#include "agent/two_rooms.h"

namespace crossnav::agent::testing {
namespace {

using test::BoxWalker;
using test::FakeSight;
using test::FakeSuite;

/// A couch and a plant; only the couch has features of its own.
FakeSight CouchAndPlant(const Box3& couch, const Box3& plant) {
  return AndBox(CouchSight(couch), plant, "plant");
}

const Box3 kPlant = BoxOf(2.9, 1.8, 0, 3.4, 2.3, 0.9);     // in the first room
const Box3 kFarPlant = BoxOf(7.3, 0.1, 0, 7.8, 0.6, 0.9);  // in the second

BoxWalker RoomsWith(const Box3& plant) {
  BoxWalker walker = TwoRooms();
  walker.rooms.solids.push_back(plant);
  return walker;
}

/// The agent has found the couch; the plant was on its way.
void FindCouch(Agent& agent, BoxWalker& walker) {
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  ASSERT_EQ(RunAgent(agent, walker, 300).last_action, Action::kStop);
}

TEST(Passing, AThingMetOnTheWayIsOnRecordAndIsWalkedToTheNextDay) {
  BoxWalker walker = RoomsWith(kPlant);
  Agent first(SmallConfig(), FakeSuite(CouchAndPlant(kCouch, kPlant)));
  FindCouch(first, walker);
  const Night night = NightAfter(first);
  ASSERT_TRUE(std::any_of(night.objects.begin(), night.objects.end(), [](const auto& record) {
    return record.category == "plant" && record.box_world_m.contains(kPlant.Center());
  }));
  for (const char* mode : {"keep", "revise"}) {
    BoxWalker again = RoomsWith(kPlant);
    again.pose.p_world = Vector3d(6.0, 1.0, 0);
    Agent second(ConfigOf(mode), FakeSuite(CouchAndPlant(kCouch, kPlant)));
    Wake(night, 1, &second);
    ASSERT_TRUE(second.SetGoal("plant").has_value());
    const Walk walk = RunAgent(second, again, 300);
    EXPECT_EQ(walk.last_action, Action::kStop) << mode;
    EXPECT_TRUE(std::any_of(walk.traces.begin(), walk.traces.end(), IsVisit)) << mode;
    EXPECT_LT(walk.traces.size(), 80U) << mode;
  }
}

TEST(Passing, AThingThatTheGridCutsIntoFewVoxelsIsOnRecord) {
  const Box3 small = BoxOf(2.905, 1.805, 0, 3.095, 1.995, 0.19);  // no side has ten voxels
  const auto is_known = [&](const Config& config) {
    BoxWalker walker = RoomsWith(small);
    Agent agent(config, FakeSuite(CouchAndPlant(kCouch, small)));
    FindCouch(agent, walker);
    const Night night = NightAfter(agent);
    return std::any_of(night.objects.begin(), night.objects.end(),
                       [](const auto& record) { return record.category == "plant"; });
  };
  Config config = SmallConfig();
  EXPECT_TRUE(is_known(config));
  // Where no single frame is believed, ten voxels are asked for, as by the paper.
  config.verify.evidence = "views";
  EXPECT_FALSE(is_known(config));
}

TEST(Passing, AThingMetOnTheWayIsARememberedPlaceOfALaterGoal) {
  for (const bool use_history : {true, false}) {
    BoxWalker walker = RoomsWith(kPlant);
    Config config = SmallConfig();
    config.policy.poi.use_history = use_history;
    Agent agent(config, FakeSuite(CouchAndPlant(kCouch, kPlant)));
    FindCouch(agent, walker);
    ASSERT_TRUE(agent.SetGoal("plant").has_value());
    const Walk walk = RunAgent(agent, walker, 300);
    EXPECT_EQ(walk.last_action, Action::kStop);
    EXPECT_EQ(std::any_of(walk.traces.begin(), walk.traces.end(), IsVisit), use_history);
  }
}

TEST(Passing, AThingThatMovedIsKnownWhereItWasMetToday) {
  BoxWalker walker = RoomsWith(kFarPlant);
  Agent first(SmallConfig(), FakeSuite(CouchAndPlant(kCouch, kFarPlant)));
  FindCouch(first, walker);
  const Night night = NightAfter(first);
  BoxWalker later = Rearranged(&kMovedCouch);
  later.rooms.solids.push_back(kFarPlant);
  later.pose.p_world = Vector3d(2.5, 3.0, 0);
  later.pose.yaw_rad = DegToRad(-130);  // towards the couch
  Agent second(ConfigOf("revise"), FakeSuite(CouchAndPlant(kMovedCouch, kFarPlant)));
  Wake(night, 1, &second);
  ASSERT_TRUE(second.SetGoal("plant").has_value());
  ASSERT_EQ(RunAgent(second, later, 300).last_action, Action::kStop);
  ASSERT_TRUE(second.SetGoal("couch").has_value());
  const Walk walk = RunAgent(second, later, 300);
  EXPECT_EQ(walk.last_action, Action::kStop);
  // From the far plant back to the first room: no round through the second.
  EXPECT_LT(walk.traces.size(), 80U);
}

}  // namespace
}  // namespace crossnav::agent::testing
