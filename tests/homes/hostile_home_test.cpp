// SPDX-License-Identifier: MIT
// Homes that are damaged or meant to harm: one clear error, nothing written, no crash.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "crossnav/core/rng.h"
#include "crossnav/homes/home_xml.h"
#include "crossnav/homes/scene_import.h"
#include "home_maker.h"
#include "support/temp_folder.h"

namespace crossnav::homes {
namespace {

namespace fs = std::filesystem;
using test::Entries;
using test::TwoStoreyHome;
using test::With;

class HostileHome : public testing::Test {
 protected:
  Result<ImportReport> ImportBytes(const std::string& bytes) {
    ImportOptions options;
    options.input = folder_.path() / "home.sh3d";
    std::ofstream(options.input, std::ios::binary) << bytes;
    options.out_dir = folder_.path() / "scenes";
    return ImportScene(options);
  }
  Result<ImportReport> Import(const Entries& entries) {
    return ImportBytes(crossnav::test::Zip(entries));
  }

  /// The error names all `parts`, and nothing is left behind.
  void ExpectError(const Entries& entries, const std::vector<std::string>& parts) {
    const auto report = Import(entries);
    ASSERT_FALSE(report.has_value()) << parts.front();
    const std::string message = report.error().Message();
    EXPECT_NE(message.find("home.sh3d"), message.npos) << message;
    for (const auto& part : parts) EXPECT_NE(message.find(part), message.npos) << message;
    EXPECT_FALSE(fs::exists(folder_.path() / "scenes")) << message;
  }

  crossnav::test::TempFolder folder_;
};

TEST_F(HostileHome, ErrorsNameTheFileTheElementAndTheRemedy) {
  ExpectError({{"Home", "old"}}, {"holds no Home.xml", "save it again"});
  ExpectError({{"Home.xml", "<home><wall"}}, {"Home.xml", "line 1", "not well-formed"});
  ExpectError({{"Home.xml", "<house/>"}}, {"no <home> element"});
  ExpectError({{"Home.xml", "<home/>"}}, {"draws nothing"});
  ExpectError(With(TwoStoreyHome(), "xStart='350.000000'", "xStart='NaN'"),
              {"<wall id='gi'>", "xStart='NaN'", "Sweet Home 3D"});
  ExpectError(With(TwoStoreyHome(), "xStart='350.000000'", "xStart='1e300'"), {"1e300"});
  ExpectError(With(TwoStoreyHome(), "xStart='350.000000'", "xStart='12,5'"), {"12,5"});
  ExpectError(With(TwoStoreyHome(), "xStart='350.000000' ", ""), {"has no attribute xStart"});
  ExpectError(With(TwoStoreyHome(), "width='140'", "width='-140'"), {"Lit 140x190", "below 0"});
  ExpectError(With(TwoStoreyHome(), "level='u' name='Red", "level='attic' name='Red"),
              {"Red wooden chair", "'attic' does not exist"});
  ExpectError(With(TwoStoreyHome(), "M0,0 v1", "M0,0 v"), {"staircaseCutOutShape"});
  ExpectError(With(TwoStoreyHome(), "width='45'", "width='45' modelRotation='1 0 0 0 inf 0 0 0 1'"),
              {"modelRotation"});
  ImportOptions absent;
  absent.input = folder_.path() / "absent.sh3d";
  absent.out_dir = folder_.path() / "scenes";
  const auto report = ImportScene(absent);
  ASSERT_FALSE(report.has_value());
  EXPECT_EQ(report.error().code, ErrorCode::kNotFound);
}

TEST_F(HostileHome, APlanWith20000WallsOrOtherwiseBeyondAnyHomeIsRefused) {
  const auto home = [](const std::string& element, int count) {
    std::string xml = "<home>";
    for (int i = 0; i < count; ++i) xml += element;
    return Entries{{"Home.xml", xml + "</home>"}};
  };
  ExpectError(home("<wall xStart='0' yStart='0' xEnd='9' yEnd='9' thickness='1'/>", 20'000),
              {"more than 5000 walls"});
  ExpectError(home("<level elevation='0'/>", 1000), {"more than 64 levels"});
  ExpectError(
      home("<room><point x='0' y='0'/><point x='9' y='0'/><point x='9' y='9'/></room>", 1000),
      {"more than 500 rooms"});
  ExpectError(home("<doorOrWindow x='0' y='0' width='1' depth='1' height='1'/>", 2000),
              {"more than 1000 doors and windows"});
  std::string room = "<room>";
  for (int i = 0; i < 600; ++i) room += "<point x='" + std::to_string(i) + "' y='0'/>";
  ExpectError(home(room + "</room>", 1), {"more than 500 corners"});
}

TEST_F(HostileHome, NamesCannotLeaveTheOutputFolder) {
  for (const char* name : {"../evil", "a/b", "..", "00001-..", "00001-../x", "-", "a\"b"}) {
    ImportOptions options;
    options.input = test::WriteArchive(folder_.path() / "home.sh3d", TwoStoreyHome());
    options.out_dir = folder_.path() / "scenes";
    options.name = name;
    const auto report = ImportScene(options);
    ASSERT_FALSE(report.has_value()) << name;
    EXPECT_EQ(report.error().where, "--name");
    EXPECT_FALSE(fs::exists(folder_.path() / "scenes"));
  }
}

TEST_F(HostileHome, AFolderThatIsNoSceneIsNotOverwritten) {
  const fs::path mine = folder_.path() / "scenes/00001-home";
  fs::create_directories(mine);
  std::ofstream(mine / "letters.txt") << "dear";
  const auto report = Import(TwoStoreyHome());
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().what.find("is not a scene"), std::string::npos);
  EXPECT_TRUE(fs::exists(mine / "letters.txt"));
}

TEST_F(HostileHome, ModelsThatNameFilesOutsideOrAreBrokenBecomeBoxes) {
  Entries entries = TwoStoreyHome();
  entries["3/bed.obj"] = "mtllib ../../../../etc/passwd\nusemtl x\nf 1 2 3\n";
  entries["2"] = std::string("PK\x03\x04", 4) + "no archive";
  const auto report = Import(With(entries, "model='1'", "model='../../../etc/passwd'"));
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  int boxes = 0;
  for (const auto& note : report->notes) boxes += note.find("shown as a box") != note.npos ? 1 : 0;
  EXPECT_EQ(boxes, 4);
}

TEST_F(HostileHome, AnEntryThatClaimsToBeHugeIsNotUnpacked) {
  std::string bytes = crossnav::test::Zip(TwoStoreyHome());
  // The directory's record of Home.xml: its unpacked size.
  const auto record = bytes.rfind("Home.xml") - 46;
  ASSERT_EQ(bytes.compare(record, 4, "PK\x01\x02"), 0);
  bytes.replace(record + 24, 4, std::string("\xff\xff\xff\x7f", 4));
  const auto report = ImportBytes(bytes);
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().what.find("above 64 MiB"), std::string::npos);
}

TEST_F(HostileHome, GroupsInGroupsAndEntitiesDoNotRunAway) {
  std::string deep = "<home>";
  for (int i = 0; i < 5000; ++i) deep += "<furnitureGroup>";
  for (int i = 0; i < 5000; ++i) deep += "</furnitureGroup>";
  const auto plan = ParseHomeXml(deep + "</home>", "deep");
  ASSERT_FALSE(plan.has_value());
  EXPECT_NE(plan.error().what.find("nested deeper"), std::string::npos);
  const auto laughs = ParseHomeXml(
      "<?xml version='1.0'?><!DOCTYPE h [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;'>]>"
      "<home name='&b;'/>",
      "laughs");
  ASSERT_TRUE(laughs.has_value()) << laughs.error().Message();
  EXPECT_EQ(laughs->name, "&b;");
}

TEST_F(HostileHome, CutArchivesAreErrorsAndNothingIsWritten) {
  const std::string bytes = crossnav::test::Zip(TwoStoreyHome());
  for (std::size_t n = 0; n < bytes.size(); n += 97) {
    const auto report = ImportBytes(bytes.substr(0, n));
    ASSERT_FALSE(report.has_value()) << n;
    EXPECT_FALSE(fs::exists(folder_.path() / "scenes"));
  }
}

TEST_F(HostileHome, DamagedDescriptionsNeverCrash) {
  const std::string whole = test::TwoStoreyXml();
  Rng rng(11);
  const std::string_view bad = "<>'\"=&;0-.eNx/\0\xff";
  int read = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string xml = whole;
    for (int k = rng.Int(1, 4); k > 0; --k) {
      const auto at = rng.Below(static_cast<std::uint32_t>(xml.size()));
      const auto c = bad[rng.Below(static_cast<std::uint32_t>(bad.size()))];
      if (rng.Below(3) == 0) {
        xml.erase(at, rng.Below(40));
      } else {
        xml[at] = c;
      }
    }
    const auto plan = ParseHomeXml(xml, "damaged");
    if (plan) {
      ++read;
    } else {
      EXPECT_FALSE(plan.error().what.empty());
      EXPECT_EQ(plan.error().where.rfind("damaged", 0), 0U);
    }
  }
  EXPECT_GT(read, 100) << "some damage lies where nobody reads";
  EXPECT_LT(read, 2900);
}

}  // namespace
}  // namespace crossnav::homes
