// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "crossnav/core/categories.h"
#include "crossnav/sim/scene/scene_reader.h"

namespace crossnav::sim::test {
namespace {

constexpr char kHeader[] = "HM3D Semantic Annotations\n";

std::string ErrorOf(const std::string& text) {
  const auto lines = ParseSemanticText(text, "x.semantic.txt");
  return lines ? "no error" : lines.error().Message();
}

TEST(SemanticText, NamesMayHoldCommasAndLinesMayEndWithCarriageReturn) {
  const auto lines = ParseSemanticText(std::string(kHeader) + "1,593A3A,\"wall\",0\r\n" +
                                           "17,1f3d87,\"shelf, with \"tv\", old\",12\n",
                                       "x");
  ASSERT_TRUE(lines.has_value()) << lines.error().Message();
  ASSERT_EQ(lines->size(), 2U);
  EXPECT_EQ((*lines)[0].colour, 0x593A3AU);
  EXPECT_EQ((*lines)[1].id, 17);
  EXPECT_EQ((*lines)[1].name, "shelf, with \"tv\", old");
  EXPECT_EQ((*lines)[1].region, 12);
}

TEST(SemanticText, MalformedLinesAreNamedByFileAndLine) {
  const std::string good = std::string(kHeader) + "1,593A3A,\"wall\",0\n";
  EXPECT_EQ(ErrorOf("1,593A3A,\"wall\",0\n"),
            "x.semantic.txt, line 1: the header \"HM3D Semantic Annotations\" is missing");
  EXPECT_EQ(ErrorOf(""),
            "x.semantic.txt, line 1: the header \"HM3D Semantic Annotations\" is missing");
  EXPECT_EQ(ErrorOf(good + "two,1F3D87,\"door\",0\n"),
            "x.semantic.txt, line 3: the instance id is not a positive number");
  EXPECT_EQ(ErrorOf(good + "0,1F3D87,\"door\",0\n"),
            "x.semantic.txt, line 3: the instance id is not a positive number");
  EXPECT_EQ(ErrorOf(good + "2,1F3D8,\"door\",0\n"),
            "x.semantic.txt, line 3: the colour is not six hexadecimal digits");
  EXPECT_EQ(ErrorOf(good + "\n2,1F3D87,door,0\n"),
            "x.semantic.txt, line 4: the name is not in double quotes");
  EXPECT_EQ(ErrorOf(good + "2,1F3D87,\"door\",x\n"),
            "x.semantic.txt, line 3: the region is not a number");
  EXPECT_EQ(ErrorOf(good + "2,1F3D87\n"),
            "x.semantic.txt, line 3: expected id,HEXRGB,\"name\",region");
}

TEST(SemanticText, DuplicateIdsAndColoursAreNoted) {
  const std::string text = std::string(kHeader) +
                           "1,593A3A,\"wall\",0\n1,1F3D87,\"door\",0\n"
                           "2,593A3A,\"bed\",0\n3,0000FF,\"rug\",0\n";
  std::vector<std::string> notes;
  const auto lines = ParseSemanticText(text, "x.semantic.txt", &notes);
  ASSERT_TRUE(lines.has_value()) << lines.error().Message();
  EXPECT_EQ(lines->size(), 4U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0],
            "x.semantic.txt, line 3: instance id is already used in line 2 (and 1 more); the first "
            "line with an id names it, the first with a colour has its surfaces");
}

TEST(CategoryTable, BuiltInNamesAreExactNeverSubstrings) {
  const CategoryTable& table = DefaultCategories();
  const auto category = [&](const char* name) {
    const auto it = table.find(std::string_view(name));
    return it == table.end() ? std::string("none") : it->second;
  };
  EXPECT_EQ(category("chair"), "chair");
  EXPECT_EQ(category("armchair"), "chair");
  EXPECT_EQ(category("couch"), "sofa");
  EXPECT_EQ(category("potted plant"), "plant");
  EXPECT_EQ(category("tv"), "tv_monitor");
  EXPECT_EQ(category("bed"), "bed");
  EXPECT_EQ(category("toilet"), "toilet");
  for (const char* no_goal : {"stool", "bench", "bathtub", "bedside table", "tv stand", "chair leg",
                              "plant stand", "toilet paper", "sofa cushion", "bed curtain", ""}) {
    EXPECT_EQ(category(no_goal), "none") << no_goal;
  }
  for (const auto& [name, goal] : table) {
    EXPECT_NE(std::find(kCategories.begin(), kCategories.end(), goal), kCategories.end()) << name;
  }
}

TEST(CategoryTable, BrokenTablesAreNamedByLine) {
  const auto error = [](const char* text) {
    const auto table = ParseCategoryTable(text, "t.tsv");
    return table ? std::string("no error") : table.error().Message();
  };
  EXPECT_EQ(error("# comment\nchair\tchair\n"), "no error");
  EXPECT_EQ(error("chair chair\n"), "t.tsv, line 1: expected \"raw name<TAB>category\"");
  EXPECT_EQ(error("\nthrone\tthrone\n"),
            "t.tsv, line 2: \"throne\" is not one of the six categories");
  EXPECT_EQ(error("a\tbed\na\tsofa\n"), "t.tsv, line 2: the raw name is listed twice");
}

}  // namespace
}  // namespace crossnav::sim::test
