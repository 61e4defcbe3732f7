// SPDX-License-Identifier: MIT
#include "crossnav/language/answer.h"

#include <gtest/gtest.h>

#include "language/random_description.h"
#include "language/small_home.h"

namespace crossnav::language {
namespace {

struct Asking : SmallHome, testing::Test {
  Answer To(const std::string& text) {
    const auto question = ParseQuestion(text);
    EXPECT_TRUE(question.has_value()) << (question ? "" : question.error().Message());
    return question ? AnswerTo(*question, home) : Answer();
  }
};

TEST_F(Asking, WhereIsAnsweredWithPlaceTimeAndConfidence) {
  const Answer answer = To("where did I last see a bed?");
  EXPECT_EQ(answer.things, std::vector<int>{bed});
  EXPECT_TRUE(answer.is_known);
  EXPECT_NE(answer.text.find("(bedroom) on the first floor"), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("last seen on day 2, step 120; confidence 0.90"), std::string::npos);
}

TEST_F(Asking, TheLastSeenComesFirst) {
  home.things[far_chair].last_seen = LastSeen{3, 2};
  EXPECT_EQ(To("where are the chairs").things.front(), far_chair);
}

TEST_F(Asking, WhatIsNotKnownIsSaidToBeUnknown) {
  const Answer toilet = To("where is the toilet?");
  EXPECT_TRUE(toilet.things.empty());
  EXPECT_FALSE(toilet.is_known);
  EXPECT_EQ(toilet.unseen, std::vector<int>{3});
  EXPECT_TRUE(To("where is the toilet downstairs?").is_known);
  EXPECT_FALSE(To("is there a toilet").is_true.has_value());
  EXPECT_EQ(To("is there a toilet on the ground floor").is_true, false);
  EXPECT_EQ(To("is there a bed on the first floor").is_true, true);
  EXPECT_FALSE(To("is there a bed on the third floor").is_true.has_value());
}

TEST_F(Asking, CountsSayWhetherTheyAreComplete) {
  const Answer down = To("how many chairs are downstairs");
  EXPECT_EQ(down.count, 2);
  EXPECT_TRUE(down.is_known);
  const Answer up = To("How many chairs are there upstairs?");
  EXPECT_EQ(up.count, 1);
  EXPECT_FALSE(up.is_known);
  EXPECT_EQ(To("how many red chairs are there").count, 2);
  EXPECT_EQ(To("how many floors are there").count, 2);
  EXPECT_EQ(To("how many rooms are upstairs").count.value_or(-1) +
                static_cast<int>(To("how many rooms are upstairs").unseen.size()),
            2);
}

TEST_F(Asking, AFloorThatTheMapDoesNotHaveIsUnknownNotEmpty) {
  for (const char* text :
       {"how many chairs are on the third floor", "what is on the third floor",
        "which rooms on the third floor have no plant", "how many rooms are on the third floor"}) {
    const Answer answer = To(text);
    EXPECT_FALSE(answer.is_known) << text;
    EXPECT_FALSE(answer.count.has_value()) << text;
    EXPECT_TRUE(answer.things.empty() && answer.rooms.empty()) << text;
    EXPECT_NE(answer.text.find("the map has 2 floors"), std::string::npos) << answer.text;
  }
}

TEST_F(Asking, RoomsWithAndWithout) {
  const Answer none = To("which rooms have no plant");
  EXPECT_EQ(none.rooms, (std::vector<int>{1, 2}));
  EXPECT_EQ(none.unseen, std::vector<int>{3}) << "it was not looked at";
  EXPECT_FALSE(none.is_known);
  EXPECT_EQ(To("which rooms have a chair?").rooms, (std::vector<int>{0, 2}));
  EXPECT_EQ(To("which rooms downstairs have no plant?").rooms, std::vector<int>{1});
  EXPECT_EQ(To("which rooms have no plant downstairs?").rooms, std::vector<int>{1});
  EXPECT_EQ(To("which room is the bed in").things, std::vector<int>{bed});
}

TEST_F(Asking, WhatStandsOnSomethingAndInARoom) {
  EXPECT_EQ(To("what is on the dining table").things, std::vector<int>{plant});
  EXPECT_EQ(To("what's in the bedroom?").things, (std::vector<int>{bed, upper_chair}));
  const Answer desk = To("what is on the desk");
  EXPECT_FALSE(desk.is_known);
  EXPECT_NE(desk.text.find("no desk is known"), std::string::npos) << desk.text;
}

TEST_F(Asking, NoSofaStandsOnATableThoughTheirBoxesOverlap) {
  Add("sofa", 0, {3, 3, 0.6}, {0.8, 0.8, 0.7});
  Add("window", 0, {3, 3.2, 1.3}, {0.8, 0.1, 1});
  EXPECT_EQ(To("what is on the dining table").things, std::vector<int>{plant});
}

TEST(Questions, ErrorsSayWhatCanBeAsked) {
  const auto why = ParseQuestion("why is the sky blue");
  ASSERT_FALSE(why);
  EXPECT_NE(why.error().what.find("where is"), std::string::npos) << why.error().what;
  EXPECT_FALSE(ParseQuestion(""));
  EXPECT_FALSE(ParseQuestion("where is"));
  EXPECT_FALSE(ParseQuestion("how many"));
  EXPECT_FALSE(ParseQuestion("what is"));
  EXPECT_FALSE(ParseQuestion("which rooms have"));
}

TEST(Questions, EveryGeneratedQuestionParsesToItsSubject) {
  Rng rng(9);
  for (int i = 0; i < 1000; ++i) {
    const Description d = RandomDescription(rng);
    if (IsInToilet(d) || TextOf(d).size() > 200) continue;
    const auto parsed = ParseQuestion("where is " + TextOf(d) + "?");
    ASSERT_TRUE(parsed) << TextOf(d);
    EXPECT_EQ(parsed->subject, d);
  }
}

}  // namespace
}  // namespace crossnav::language
