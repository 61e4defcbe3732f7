// SPDX-License-Identifier: MIT
#include "crossnav/world/change/changes.h"

#include <string>

#include <gtest/gtest.h>

namespace crossnav::world {
namespace {

DayChanges SomeChanges() {
  DayChanges day;
  day.scene = "00001-Ring-day2";
  day.before = "00001-Ring-day1";
  day.day = 2;
  day.seed = 18446744073709551615ULL;
  Change moved;
  moved.kind = ChangeKind::kOtherFloor;
  moved.instance = 7;
  moved.name = "reading \"chair\"";
  moved.category = "chair";
  moved.from = ChangePlace{{1, 2, 0}, {{0.5, 1.5, 0}, {1.5, 2.5, 1}}, 3, 0, 12};
  moved.to = ChangePlace{{1.25, 2, 3}, {{1, 1.5, 3}, {1.5, 2.5, 4}}, -1, -1, 0};
  Change door;
  door.kind = ChangeKind::kDoorClosed;
  door.instance = 9;
  door.name = "door";
  door.to = moved.from;
  day.changes = {moved};
  day.lifted = {door};
  return day;
}

TEST(Changes, TheListIsReadAsItWasWritten) {
  const std::string text = ChangesText(SomeChanges());
  const auto read = ParseChanges(text, "changes.json");
  ASSERT_TRUE(read.has_value()) << read.error().Message();
  EXPECT_EQ(ChangesText(*read), text);
  EXPECT_EQ(read->seed, SomeChanges().seed);
  EXPECT_EQ(read->changes[0].from->support, 12);
  EXPECT_EQ(read->changes[0].to->room, -1);
}

TEST(Changes, ATruncatedListIsAnErrorAtEveryLength) {
  const std::string text = ChangesText(SomeChanges());
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    const auto read = ParseChanges(text.substr(0, size), "changes.json");
    ASSERT_FALSE(read.has_value()) << size;
  }
}

TEST(Changes, DamageNamesTheKey) {
  const auto damaged = [](const std::string& from, const std::string& to) {
    std::string text = ChangesText(SomeChanges());
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const auto read = ParseChanges(text, "changes.json");
    return read ? std::string() : read.error().Message();
  };
  EXPECT_NE(damaged("\"other_floor\"", "\"flown\"").find("changes[0].kind"), std::string::npos);
  EXPECT_NE(damaged("\"instance\": 7", "\"instance\": -7").find("changes[0].instance"),
            std::string::npos);
  EXPECT_NE(damaged("\"from\"", "\"form\"").find("changes[0]"), std::string::npos);
  EXPECT_NE(damaged("\"format\": 1", "\"format\": 2").find("format"), std::string::npos);
  EXPECT_NE(damaged("\"lifted\"", "\"lofted\"").find("lifted"), std::string::npos);
  EXPECT_NE(damaged("1.25", "1e999").find("changes"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::world
