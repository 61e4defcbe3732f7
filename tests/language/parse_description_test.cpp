// SPDX-License-Identifier: MIT
#include "crossnav/language/parse_description.h"

#include <gtest/gtest.h>

#include "language/random_description.h"

namespace crossnav::language {
namespace {

Description Parsed(const std::string& text) {
  const auto parsed = ParseDescription(text);
  EXPECT_TRUE(parsed.has_value()) << (parsed ? "" : parsed.error().Message());
  return parsed ? *parsed : Description();
}

std::string ErrorOf(const std::string& text) {
  const auto parsed = ParseDescription(text);
  EXPECT_FALSE(parsed.has_value()) << text;
  return parsed ? "" : parsed.error().Message();
}

TEST(ParseDescription, SaysCategoryColourRelationAndFloor) {
  const Description d = Parsed("the red armchair near the window upstairs");
  EXPECT_EQ(d.noun, "chair");
  EXPECT_TRUE(d.is_definite);
  EXPECT_EQ(d.colour, Colour::kRed);
  ASSERT_EQ(d.relations.size(), 1U);
  EXPECT_EQ(d.relations[0].relation, Relation::kNear);
  EXPECT_EQ(d.relations[0].landmark.noun, "window");
  EXPECT_EQ(d.floor, (FloorPhrase{FloorWord::kUpstairs, 0}));
}

TEST(ParseDescription, SaysOrdinalAndRoom) {
  const Description d = Parsed("The second chair in the kitchen.");
  EXPECT_EQ(d.order, 2);
  EXPECT_EQ(d.room, RoomType::kKitchen);
  EXPECT_EQ(Parsed("the kitchen chair"), Parsed("the chair")) << "a name of the table goes first";
  EXPECT_EQ(Parsed("the bedroom plant").room, RoomType::kBedroom);
}

TEST(ParseDescription, OnIsARelationOrAFloor) {
  EXPECT_EQ(Parsed("the plant on the table").relations.at(0).relation, Relation::kOn);
  const Description bed = Parsed("a bed on the first floor");
  EXPECT_EQ(bed.floor, (FloorPhrase{FloorWord::kNumber, 1}));
  EXPECT_FALSE(bed.is_definite);
  EXPECT_EQ(Parsed("the first floor lamp").order, 1);
  EXPECT_EQ(Parsed("the first floor bed").floor, (FloorPhrase{FloorWord::kNumber, 1}));
}

TEST(ParseDescription, RoomsAreSaidOfTheWhole) {
  const Description d = Parsed("the chair next to the couch in the living room");
  EXPECT_EQ(d.room, RoomType::kLiving);
  ASSERT_EQ(d.relations.size(), 1U);
  EXPECT_EQ(d.relations[0].landmark.noun, "sofa");
  EXPECT_FALSE(d.relations[0].landmark.room);
  EXPECT_EQ(Parsed("the plant in the toilet").room, RoomType::kWc);
}

TEST(ParseDescription, ARelationBelongsToTheThingBeforeItAndAfterAndToTheFirst) {
  const Description inner = Parsed("a chair near the table next to the sofa");
  ASSERT_EQ(inner.relations.size(), 1U);
  EXPECT_EQ(inner.relations[0].landmark.relations.at(0).landmark.noun, "sofa");
  EXPECT_EQ(Parsed("a chair near the table and next to the sofa").relations.size(), 2U);
}

TEST(ParseDescription, ErrorsNameTheWordAndTheNearestThatIsKnown) {
  const std::string leftmost = ErrorOf("the leftmost chair");
  EXPECT_NE(leftmost.find("\"leftmost\" is not understood"), std::string::npos) << leftmost;
  EXPECT_NE(ErrorOf("the tabel").find("did you mean \"table\"?"), std::string::npos);
  EXPECT_NE(ErrorOf("the chair on the").find("ends where"), std::string::npos);
  EXPECT_NE(ErrorOf("the chair in the kitchen in the bedroom"), "");
  EXPECT_NE(ErrorOf(""), "");
  EXPECT_NE(ErrorOf(" ,.? "), "");
}

TEST(ParseDescription, EveryGeneratedSentenceParsesToWhatMadeIt) {
  Rng rng(7);
  for (int i = 0; i < 5000; ++i) {
    const Description d = RandomDescription(rng);
    if (IsInToilet(d)) continue;
    const auto parsed = ParseDescription(TextOf(d));
    ASSERT_TRUE(parsed.has_value()) << TextOf(d) << ": " << parsed.error().Message();
    EXPECT_EQ(*parsed, d) << TextOf(d) << " -> " << TextOf(*parsed);
  }
}

TEST(ParseDescription, GarbageIsAnErrorAndNeverMore) {
  Rng rng(8);
  const std::string letters =
      "the a chair on in next to red kitchen floor first and upstairs,\xff\xc3'-_";
  for (int i = 0; i < 3000; ++i) {
    std::string text;
    for (int n = static_cast<int>(rng.Below(120)); n > 0; --n)
      text +=
          rng.Chance(0.1) ? static_cast<char>(rng.Below(256)) : letters[rng.Below(letters.size())];
    const auto parsed = ParseDescription(text);
    EXPECT_TRUE(parsed || !parsed.error().what.empty());
  }
  EXPECT_FALSE(ParseDescription(std::string(100000, 'a')));
  std::string chain = "the chair";
  for (int i = 0; i < 30; ++i) chain += " on the chair";
  EXPECT_FALSE(ParseDescription(chain));
}

TEST(IsDescription, NamesStayNames) {
  for (const char* name :
       {"chair", "tv_monitor", "potted plant", "chest of drawers", "couch", "something else",
        "vase with flowers", "", "picture on frame", "red box", "second chair", "theatre"})
    EXPECT_FALSE(IsDescription(name)) << name;
  for (const char* text : {"the chair", "the red chair", "a bed on the first floor",
                           "any chair upstairs", "the leftmost chair", "a plant on the table"})
    EXPECT_TRUE(IsDescription(text)) << text;
}

TEST(Colours, AreNamedAsPeopleWould) {
  EXPECT_EQ(NameColour({200, 30, 30}), Colour::kRed);
  EXPECT_EQ(NameColour({150, 110, 75}), Colour::kBrown);
  EXPECT_EQ(NameColour({60, 90, 160}), Colour::kBlue);
  EXPECT_EQ(NameColour({128, 128, 130}), Colour::kGrey);
  EXPECT_EQ(FitOf(Colour::kRed, {200, 30, 30}), Fit::kYes);
  EXPECT_EQ(FitOf(Colour::kGreen, {200, 30, 30}), Fit::kNo);
  EXPECT_EQ(FitOf(Colour::kWhite, {170, 170, 170}), Fit::kMaybe);
}

TEST(RoomTypes, FollowFromWhatStandsInARoom) {
  const std::vector<std::string> kitchen = {"refrigerator", "stove", "chair"},
                                 open = {"sofa", "stove", "dining table"}, wc = {"toilet"},
                                 bath = {"toilet", "bathtub"};
  const auto fit = [](const std::vector<std::string>& things, RoomType type) {
    return RoomFitsOf(things, true)[static_cast<int>(type)];
  };
  EXPECT_EQ(fit(kitchen, RoomType::kKitchen), Fit::kYes);
  EXPECT_EQ(fit(kitchen, RoomType::kBedroom), Fit::kNo);
  EXPECT_EQ(fit(open, RoomType::kKitchen), Fit::kYes);
  EXPECT_EQ(fit(open, RoomType::kLiving), Fit::kYes);
  EXPECT_EQ(fit(bath, RoomType::kWc), Fit::kNo);
  EXPECT_EQ(fit(bath, RoomType::kBathroom), Fit::kYes);
  EXPECT_EQ(fit(wc, RoomType::kWc), Fit::kYes);
  EXPECT_EQ(fit({}, RoomType::kBedroom), Fit::kNo) << "it was looked at: there is no bed";
  EXPECT_EQ(fit({}, RoomType::kHall), Fit::kMaybe);
  EXPECT_EQ(RoomFitsOf({}, false)[static_cast<int>(RoomType::kBedroom)], Fit::kMaybe);
}

}  // namespace
}  // namespace crossnav::language
