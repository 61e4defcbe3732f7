// SPDX-License-Identifier: MIT
#include "crossnav/localization/localizer.h"

#include <gtest/gtest.h>

#include "localization/lost_robot.h"

namespace crossnav::localization {
namespace {

using crossnav::testing::BoxOf;
using crossnav::testing::BoxRooms;
using test::BoxWalker;
using test::MapOf;
using test::WakeUp;

BoxWalker WalkerIn(const BoxRooms& rooms, const AgentPose& pose) {
  BoxWalker walker{rooms, pose, test::SmallSensor(), {}};
  walker.pose.pitch_rad = 0;
  return walker;
}

TEST(Localizer, PoseAndFloorAreFoundAnywhereInAHouse) {
  const BoxRooms rooms = crossnav::testing::MakeBoxHouse(3, 8, 6, 2);
  const auto map = MapOf(rooms, 2);
  Rng rng(7);
  for (int i = 0; i < 4; ++i) {
    const auto stand = crossnav::testing::RandomStand(rng, rooms, i % 2);
    const auto waking = WakeUp(WalkerIn(rooms, stand), map);
    EXPECT_TRUE(waking.IsRight()) << i << ": " << NameOf(waking.answer.status) << ", off "
                                  << waking.off_m << " m " << waking.off_deg << " deg";
  }
}

TEST(Localizer, SameObservationsGiveTheSameAnswer) {
  const BoxRooms rooms = crossnav::testing::MakeBoxHouse(4, 6, 5);
  const auto map = MapOf(rooms);
  Rng rng(1);
  const auto walker = WalkerIn(rooms, crossnav::testing::RandomStand(rng, rooms, 0));
  const auto first = WakeUp(walker, map), second = WakeUp(walker, map);
  EXPECT_EQ(first.actions, second.actions);
  EXPECT_TRUE(first.answer.T_map_odom.matrix() == second.answer.T_map_odom.matrix());
}

TEST(Localizer, FloorsThatAreTheSameWithNoWayBetweenThemAreUnknown) {
  BoxRooms rooms;
  rooms.shell = BoxOf(0, 0, 0, 6, 5, 5.4);
  rooms.solids = {BoxOf(0, 0, 2.6, 6, 5, 2.8)};
  for (const double floor_m : {0.0, 2.8}) {
    rooms.solids.push_back(BoxOf(1, 1, floor_m, 2, 1.6, floor_m + 0.8));
    rooms.solids.push_back(BoxOf(4, 3.5, floor_m, 4.5, 5, floor_m + 1.9));
  }
  AgentPose stand;
  stand.p_world = {3, 2.5, 2.8};
  LocalizeConfig config;
  config.action_budget = 25;
  const auto waking = WakeUp(WalkerIn(rooms, stand), MapOf(rooms, 2), config);
  EXPECT_EQ(waking.answer.status, Status::kUnknown)
      << waking.answer.nearest.won << " to " << waking.answer.nearest.lost << " beams";
  EXPECT_GE(waking.answer.rivals, 1);
}

/// Two rooms alike, each with a door to a corridor of which one end has a cupboard.
BoxRooms LookAlikes() {
  BoxRooms rooms;
  rooms.shell = BoxOf(0, 0, 0, 8.2, 6, 2.6);
  rooms.solids = {BoxOf(4.0, 0, 0, 4.2, 4, 2.6),  // between the rooms
                  BoxOf(7.4, 5.2, 0, 8.2, 6, 2.0)};
  for (const double x : {0.0, 4.2}) {
    rooms.solids.push_back(BoxOf(x, 4, 0, x + 1.4, 4.1, 2.6));
    rooms.solids.push_back(BoxOf(x + 2.4, 4, 0, x + 4.0, 4.1, 2.6));
    rooms.solids.push_back(BoxOf(x + 1.4, 4, 2.05, x + 2.4, 4.1, 2.6));
    rooms.solids.push_back(BoxOf(x + 2.9, 0, 0, x + 4.0, 1.9, 0.6));
    rooms.solids.push_back(BoxOf(x, 0.5, 0, x + 0.4, 1.5, 1.8));
  }
  return rooms;
}

TEST(Localizer, RoomsThatLookAlikeAreToldApartByWalking) {
  const BoxRooms rooms = LookAlikes();
  const auto map = MapOf(rooms, 1, 1.0);
  for (const double x : {0.0, 4.2}) {
    AgentPose stand;
    stand.p_world = {x + 0.7, 2.4, 0};  // from where the corridor's ends are out of sight
    stand.yaw_rad = 1;
    const auto waking = WakeUp(WalkerIn(rooms, stand), map);
    EXPECT_TRUE(waking.IsRight()) << x << ": " << NameOf(waking.answer.status) << ", off "
                                  << waking.off_m << " m after " << waking.actions << " actions";
    EXPECT_GT(waking.actions, 11) << "not by looking around alone";
  }
}

TEST(Localizer, AnotherHouseIsUnknown) {
  const auto map = MapOf(crossnav::testing::MakeBoxHouse(5, 8, 6));
  const BoxRooms other = crossnav::testing::MakeBoxHouse(11, 7, 9);
  Rng rng(2);
  LocalizeConfig config;
  config.action_budget = 20;
  const auto waking =
      WakeUp(WalkerIn(other, crossnav::testing::RandomStand(rng, other, 0)), map, config);
  EXPECT_EQ(waking.answer.status, Status::kUnknown)
      << waking.answer.agreement << ", lead " << waking.answer.lead;
}

TEST(Localizer, BlindRobotGivesUpAfterOneTurn) {
  const auto map = MapOf(crossnav::testing::MakeBoxHouse(5, 5, 5));
  const PlacedMap placed = PlaceMap(map).value();
  Localizer localizer(placed, {});
  Observation obs;
  obs.camera = test::SmallSensor().Intrinsics();
  obs.depth_m = DepthImage(96, 96, 0.0F);
  obs.T_world_camera = CameraPose({}, 0.88);
  LocalizeStep step = localizer.Step(obs);
  for (int i = 0; i < 200 && step.status == Status::kLocalising; ++i) step = localizer.Step(obs);
  EXPECT_EQ(step.status, Status::kUnknown);
  EXPECT_LE(localizer.actions(), 150);
}

TEST(PlaceMap, EmptyMapIsAnError) {
  EXPECT_FALSE(PlaceMap(geometry::VoxelMap()).has_value());
}

}  // namespace
}  // namespace crossnav::localization
