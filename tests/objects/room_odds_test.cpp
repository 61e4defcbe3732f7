// SPDX-License-Identifier: MIT
// Where a thing may be that is not where it was.
#include "crossnav/objects/room_odds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

namespace crossnav::objects {
namespace {

ObjectRecord RecordOf(const std::string& category, int room, int floor, double confidence = 0.9) {
  ObjectRecord record;
  record.category = category;
  record.room = room;
  record.floor = floor;
  record.confidence = confidence;
  record.views = 5;
  return record;
}

const std::vector<RoomPlace> kRooms = {{0, 0, 15}, {1, 0, 15}, {2, 0, 15}, {3, 1, 15}};

TEST(RoomOdds, TheRoomTheFloorAndOtherFloorsCountAlike) {
  const std::vector<ObjectRecord> records = {RecordOf("plant", 0, 0, 0.01)};
  const auto odds = RoomOdds(records, kRooms, "plant");
  EXPECT_NEAR(odds.at(0), 1.0 / 3, 1e-9);
  EXPECT_NEAR(odds.at(1), 1.0 / 6, 1e-9);
  EXPECT_NEAR(odds.at(3), 1.0 / 3, 1e-9);
  double sum = 0;
  for (const auto& [room, share] : odds) sum += share;
  EXPECT_NEAR(sum, 1, 1e-9);
}

// A vase left a room of many things: they are no evidence for its return.
TEST(RoomOdds, TheFurnitureOfTheRoomThatItLeftIsNoEvidenceForThatRoom) {
  std::vector<ObjectRecord> records = {RecordOf("vase", 0, 0, 0.01)};
  for (const char* other : {"chair", "table", "oven", "sink"})
    records.push_back(RecordOf(other, 0, 0));
  for (const char* other : {"sofa", "lamp", "plant"}) records.push_back(RecordOf(other, 1, 0));
  const auto odds = RoomOdds(records, kRooms, "vase");
  EXPECT_LT(odds.at(0), 0.4);
  EXPECT_NEAR(odds.at(1), odds.at(2), 1e-9);
}

TEST(RoomOdds, RoomsWithTheFurnitureThatUsuallyStandsBesideItAreLikelier) {
  // Two plants beside sofas; room 2 has a sofa, too, and room 3 a bathtub.
  std::vector<ObjectRecord> records = {RecordOf("plant", 0, 0, 0.01), RecordOf("sofa", 0, 0),
                                       RecordOf("plant", 1, 0),       RecordOf("sofa", 1, 0),
                                       RecordOf("sofa", 2, 0),        RecordOf("bathtub", 3, 0)};
  std::vector<RoomPlace> rooms = kRooms;
  rooms[3].floor = 0;
  const auto odds = RoomOdds(records, rooms, "plant");
  EXPECT_GT(odds.at(2), 1.2 * odds.at(3));
  EXPECT_GT(Company(records, rooms, "plant", "sofa"), 1);
  EXPECT_LT(Company(records, rooms, "plant", "bathtub"), 1);
}

/// Regression: the furniture of few rooms made one of two rooms of a size seven times less likely;
/// a search ended without a look into it.
TEST(RoomOdds, OneRoomTeachesLittle) {
  std::vector<ObjectRecord> records = {RecordOf("plant", 0, 0, 0.01), RecordOf("plant", 1, 0)};
  for (const int room : {1, 2}) records.push_back(RecordOf("sofa", room, 0));
  records.push_back(RecordOf("bathtub", 3, 0));
  std::vector<RoomPlace> rooms = kRooms;
  rooms[3].floor = 0;
  const std::span<const ObjectRecord> known(records.begin() + 1, records.end());
  const double raw =
      Company(known, rooms, "plant", "sofa") / Company(known, rooms, "plant", "bathtub");
  const auto once = RoomOdds(records, rooms, "plant");
  EXPECT_GT(once.at(2), once.at(3));
  EXPECT_LT(once.at(2), std::sqrt(raw) * once.at(3));
}

TEST(RoomOdds, OnlyTheLastPlaceOfAThingThatMovedTwiceCounts) {
  std::vector<ObjectRecord> records = {RecordOf("plant", 0, 0, 0.01), RecordOf("plant", 3, 1, 0.01),
                                       RecordOf("plant", 2, 0, 0.01)};
  records[0].last_seen_day = 0;
  records[1].last_seen_day = 1;
  records[2].last_seen_day = 2;
  records[2].views = 0;  // disproved, never seen
  const auto lost = LastLost(records, "plant");
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost.front()->room, 3);
  const auto odds = RoomOdds(records, kRooms, "plant");
  EXPECT_GT(odds.at(3), 2 * odds.at(0));
}

TEST(RoomOdds, WithoutRecordsAllRoomsOfOneSizeAreAlike) {
  const auto odds = RoomOdds({}, kRooms, "chair");
  EXPECT_NEAR(odds.at(0), 0.25, 1e-9);
  EXPECT_NEAR(odds.at(3), 0.25, 1e-9);
}

TEST(RoomOdds, WhatIsNotFoundAnywhereIsGone) {
  EXPECT_LT(OddsOfAbsence(1.0), 0.3);
  EXPECT_GT(OddsOfAbsence(0.02), 0.9);
  EXPECT_EQ(OddsOfAbsence(0), 1);
}

}  // namespace
}  // namespace crossnav::objects
