// SPDX-License-Identifier: MIT
#include "crossnav/localization/belief.h"

#include <gtest/gtest.h>

#include "crossnav/localization/pose_search.h"
#include "crossnav/localization/scouting.h"
#include "crossnav/localization/walk.h"
#include "localization/lost_robot.h"

namespace crossnav::localization {
namespace {

using crossnav::testing::BoxOf;
using crossnav::testing::BoxRooms;

BoxRooms LongRoom() {
  BoxRooms rooms;
  rooms.shell = BoxOf(0, 0, 0, 12, 3, 2.6);
  rooms.solids = {BoxOf(0, 0, 0, 0.5, 0.8, 1.2)};
  return rooms;
}

TEST(Belief, FlatWallPinsNoPose) {
  const BoxRooms rooms = LongRoom();
  const auto map = test::MapOf(rooms);
  const PlacedMap placed = PlaceMap(map).value();
  test::BoxWalker walker{rooms, {}, test::SmallSensor(), {}};
  walker.pose.p_world = {6, 1.5, 0};
  walker.pose.yaw_rad = DegToRad(90);
  LocalScan scan(0.05, 7);
  scan.Add(walker.Look());
  Belief belief(placed, {});
  belief.Search(scan, walker.pose.p_world);
  ASSERT_FALSE(belief.hypotheses().empty());
  EXPECT_FALSE(belief.opinion().is_pinned);
  EXPECT_NE(belief.opinion().status, Status::kKnown);
}

TEST(Refine, BringsAPoseBackFromASmallShift) {
  const BoxRooms rooms = crossnav::testing::MakeBoxHouse(3, 8, 6);
  const auto map = test::MapOf(rooms);
  const PlacedMap placed = PlaceMap(map).value();
  Rng rng(4);
  test::BoxWalker walker{
      rooms, crossnav::testing::RandomStand(rng, rooms, 0), test::SmallSensor(), {}};
  walker.pose.pitch_rad = 0;
  LocalScan scan(0.05, 7);
  for (int i = 0; i < 12; ++i) {
    scan.Add(walker.Look());
    walker.Do(Action::kTurnLeft);
  }
  const Vector3d p_foot = walker.pose.p_world;
  Hypothesis h;
  h.T_map_odom = PlaceAt(p_foot + Vector3d(0.12, -0.1, 0), DegToRad(3), p_foot);
  Refine(placed.dense, RefinePoints(scan, p_foot, {}), p_foot, {}, h);
  EXPECT_LT((h.T_map_odom * p_foot - p_foot).norm(), 0.08);
  EXPECT_LT(std::abs(RadToDeg(YawOf(h.T_map_odom))), 1.0);
}

TEST(CheckBeams, BeamsThroughAWallContradict) {
  const BoxRooms rooms = LongRoom();
  const auto map = test::MapOf(rooms);
  const DenseMap dense = PlaceMap(map).value().dense;
  const std::vector<Beam> beams = {{Vector3f(6, 1.5F, 1), Vector3f(6, 3, 1)},
                                   {Vector3f(6, 1.5F, 1), Vector3f(6, 4.5F, 1)},
                                   {Vector3f(6, 1.5F, 1), Vector3f(6, 2.2F, 1)}};
  Hypothesis h;
  CheckBeams(dense, beams, h);
  EXPECT_EQ(h.verdicts,
            (std::vector<Verdict>{Verdict::kAgrees, Verdict::kContradicts, Verdict::kContradicts}));
}

TEST(LocalScan, FramesWithoutDepthAddNothing) {
  LocalScan scan(0.05, 7);
  Observation obs;
  obs.camera = test::SmallSensor().Intrinsics();
  obs.depth_m = DepthImage(96, 96, 0.0F);
  scan.Add(obs);
  EXPECT_EQ(scan.frames(), 0);
  EXPECT_TRUE(scan.points_odom().empty());
  EXPECT_TRUE(scan.beams().empty());
}

TEST(IsWayClear, ObstaclesAndDropsStopAStep) {
  const Body body;
  const AgentPose foot;
  const std::vector<Vector3f> ground = {{0.2F, 0, 0}, {0.3F, 0, 0}};
  EXPECT_TRUE(IsWayClear(ground, foot, body));
  EXPECT_TRUE(IsWayClear({}, foot, body)) << "nothing was seen so near";
  EXPECT_FALSE(IsWayClear({{0.2F, 0, 0.6F}, {0.2F, 0.05F, 0.7F}}, foot, body));
  EXPECT_TRUE(IsWayClear({{0.2F, 0.5F, 0.6F}, {0.2F, 0.5F, 0.7F}}, foot, body)) << "beside it";
  EXPECT_FALSE(IsWayClear({{0.25F, 0, -1.0F}}, foot, body));
}

TEST(FindOutlook, LeadsToWherePredictionsDiffer) {
  // Two rooms alike beside each other, open to a corridor that ends at a cupboard on one side.
  BoxRooms rooms;
  rooms.shell = BoxOf(0, 0, 0, 8, 5, 2.6);
  rooms.solids = {BoxOf(3.9, 0, 0, 4.1, 3.5, 2.6), BoxOf(7.2, 4.2, 0, 8, 5, 2)};
  const PlacedMap placed = PlaceMap(test::MapOf(rooms, 1, 1.0)).value();
  std::vector<Hypothesis> two(2);
  two[1].T_map_odom.translation() = Vector3d(4.1, 0, 0);
  const Outlook outlook = FindOutlook(placed.dense, placed.ground, two, 1, {2, 1, 0}, 0.88);
  ASSERT_FALSE(outlook.path_map.empty());
  EXPECT_GT(outlook.difference, 0.03);
}

}  // namespace
}  // namespace crossnav::localization
