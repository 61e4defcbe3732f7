// SPDX-License-Identifier: MIT
#include "crossnav/watch/event_log.h"

#include <gtest/gtest.h>

namespace crossnav::watch {
namespace {

std::shared_ptr<EventLog> LogOf(int count) {
  auto log = EventLog::Open("a-1").value();
  for (int i = 0; i < count; ++i)
    EXPECT_TRUE(log->Append("step", "{\"step\":" + std::to_string(i) + "}"));
  return log;
}

TEST(EventLog, EventsComeBackWholeInOrderAndWithTheirIds) {
  const auto log = LogOf(3);
  const auto piece = log->Read(1, 1 << 20);
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->text,
            "id: a-1.1\nevent: step\ndata: {\"step\":1}\n\nid: a-1.2\nevent: step\ndata: "
            "{\"step\":2}\n\n");
  EXPECT_EQ(piece->next, 3U);
  EXPECT_EQ(log->Read(3, 1 << 20)->text, "");
}

TEST(EventLog, APieceIsBoundedButHoldsAtLeastOneEvent) {
  const auto log = LogOf(100);
  EXPECT_EQ(log->Read(0, 1)->next, 1U);
  const auto piece = log->Read(10, 200);
  EXPECT_LE(piece->text.size(), 200U);
  EXPECT_GT(piece->next, 11U);
  std::string all;
  for (std::size_t next = 0; next < 100;) {
    const auto part = log->Read(next, 500);
    all += part->text;
    next = part->next;
  }
  EXPECT_EQ(all, log->Read(0, 1 << 20)->text);
  EXPECT_EQ(all.size(), log->bytes());
}

TEST(EventLog, AnIdLeadsToWhatComesBehindItAndAWrongOneToTheStart) {
  const auto log = LogOf(5);
  EXPECT_EQ(log->IndexAfter("a-1.2"), 3U);
  EXPECT_EQ(log->IndexAfter("a-1.4"), 5U);
  for (const char* wrong : {"", "2", "b.2", "a-1.", "a-1.5", "a-1.x", "a-1.2x", "a-1.-1",
                            "a-1.99999999999999999999999"}) {
    EXPECT_EQ(log->IndexAfter(wrong), 0U) << wrong;
  }
}

}  // namespace
}  // namespace crossnav::watch
