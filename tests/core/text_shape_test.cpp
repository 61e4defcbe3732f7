// SPDX-License-Identifier: MIT
#include "crossnav/core/text_shape.h"

#include <gtest/gtest.h>

#include "crossnav/core/nearest.h"

namespace crossnav {
namespace {

std::string Repeated(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

TEST(TextShape, ADottedTomlKey50000DeepIsRefusedWithItsLine) {
  const std::string key = Repeated("a.", 50'000);
  for (const std::string& text : {"x = 1\n" + key + "b = 1\n", "x = 1\n[" + key + "b]\n",
                                  "x = 1\n" + Repeated("\"a\" . ", 50'000) + "b = 1\n"}) {
    const auto ok = CheckTomlShape(text, "c.toml");
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().where, "c.toml: line 2");
    EXPECT_NE(ok.error().what.find("16 parts"), std::string::npos) << ok.error().what;
  }
}

TEST(TextShape, TomlThatPeopleWriteIsLetThrough) {
  const std::string numbers = Repeated("0.125, ", 500);
  for (const std::string& text :
       {std::string("[a.b.c]\nd.e = \"x.y.z\" # 1.2.3.4.5.6.7.8.9.10.11.12.13.14.15.16.17.18\n"),
        "list = [" + numbers + "1.0]\n", "names = [" + Repeated("\"a.b\", ", 500) + "\"c\"]\n",
        std::string("t = 2024-01-01T00:00:00.000\n"), "text = \"" + Repeated("a.", 100) + "\"\n"}) {
    EXPECT_TRUE(CheckTomlShape(text, "c.toml")) << text.substr(0, 80);
  }
}

TEST(TextShape, NestedAndLargeTomlIsRefused) {
  EXPECT_FALSE(CheckTomlShape("a = " + Repeated("[", 65), "c.toml"));
  EXPECT_TRUE(CheckTomlShape("a = " + Repeated("[", 64), "c.toml"));
  EXPECT_FALSE(CheckTomlShape(Repeated("# a comment\n", 100'000), "c.toml"));
}

TEST(TextShape, NestedJsonAndObjectsOfManyMembersAreRefused) {
  EXPECT_TRUE(CheckJsonShape(Repeated("[", 64), "a.json"));
  EXPECT_FALSE(CheckJsonShape(Repeated("[", 65), "a.json"));
  EXPECT_TRUE(CheckJsonShape("\"" + Repeated("[", 65) + "\\\"{\"", "a.json"));
  EXPECT_FALSE(CheckJsonShape("{" + Repeated("\"a\":1,", 10'001), "a.json"));
  EXPECT_TRUE(CheckJsonShape("[" + Repeated("{\"a\":1,\"b\":2},", 10'001), "a.json"));
}

TEST(TextShape, AReasonLosesTheLibrarysName) {
  EXPECT_EQ(PlainReason("[json.exception.parse_error.101] parse error"), "parse error");
  EXPECT_EQ(PlainReason("other [1] text"), "other [1] text");
}

TEST(TextShape, Utf8IsTold) {
  for (const char* text : {"", "a", "caf\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80"})
    EXPECT_TRUE(IsUtf8(text)) << text;
  for (const char* text : {"caf\xe9", "\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf8\x88\x80\x80"})
    EXPECT_FALSE(IsUtf8(text));
}

TEST(Nearest, TheNearestNameIsSuggestedWhereOneIsNear) {
  const std::vector<std::string> names = {"eval", "episodes", "map.voxel_m"};
  EXPECT_EQ(DidYouMean("evl", names), "; did you mean \"eval\"?");
  EXPECT_EQ(DidYouMean("voxel_m", names), "; did you mean \"map.voxel_m\"?");
  EXPECT_EQ(DidYouMean("unrelated_word", names), "");
  EXPECT_EQ(DidYouMean(Repeated("x", 1'000'000), names), "");
}

}  // namespace
}  // namespace crossnav
