// SPDX-License-Identifier: MIT
// Buildings as the reader of IFC files passes them on: rooms, floors, doors, furnishing, damage.
#include <gtest/gtest.h>

#include <fstream>

#include "crossnav/homes/building_home.h"
#include "crossnav/homes/building_words.h"
#include "crossnav/homes/scene_import.h"
#include "support/building_maker.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::homes {
namespace {

using world::RoomType;

ImportReport Imported(const std::filesystem::path& out, std::optional<std::uint64_t> seed,
                      const std::string& building = crossnav::test::TwoRooms()) {
  ImportOptions options;
  options.input = "two.ifc";
  options.out_dir = out;
  options.building = building;
  options.furnish = seed;
  const auto report = ImportScene(options);
  EXPECT_TRUE(report.has_value()) << report.error().Message();
  return report.value_or(ImportReport{});
}

bool HasNote(const ImportReport& report, const std::string& part) {
  for (const std::string& note : report.notes) {
    if (note.find(part) != note.npos) return true;
  }
  return false;
}

TEST(Building, RoomNamesOfSeveralLanguagesSayTheirType) {
  const std::pair<const char*, RoomType> kNames[] = {
      {"Living Room", RoomType::kLiving},      {"Küche", RoomType::kKitchen},
      {"Salle à manger", RoomType::kDining},   {"DORMITORIO 2", RoomType::kBedroom},
      {"Camera da letto", RoomType::kBedroom}, {"Kinderzimmer", RoomType::kBedroom},
      {"Badkamer", RoomType::kBathroom},       {"Gäste-WC", RoomType::kWc},
      {"Arbeitszimmer", RoomType::kOffice},    {"Korytarz", RoomType::kHall},
      {"Treppenhaus", RoomType::kStairwell},   {"Förråd", RoomType::kStorage},
      {"кухня", RoomType::kKitchen},           {"主卧室", RoomType::kBedroom}};
  for (const auto& [name, type] : kNames) EXPECT_EQ(RoomTypeNamed(name), type) << name;
  EXPECT_FALSE(RoomTypeNamed("A105").has_value());
  EXPECT_TRUE(IsNoRoom("Roof"));
  EXPECT_FALSE(IsNoRoom("Roof terrace"));
}

TEST(Building, TypeNamesOfSeveralLanguagesSayTheThing) {
  const std::pair<const char*, const char*> kNames[] = {{"M_Sofa:1830mm:1830mm:167283", "sofa"},
                                                        {"M_Bed-Standard:1525 x 2007mm", "bed"},
                                                        {"M_Table-Coffee:0610", "coffee table"},
                                                        {"Bürostuhl", "office chair"},
                                                        {"OfficeChair", "office chair"},
                                                        {"Hänge-WC", "toilet"},
                                                        {"TOILETPAN", "toilet"},
                                                        {"Mesita de noche", "nightstand"},
                                                        {"Fauteuil", "armchair"},
                                                        {"Bedside Table", "bedside table"}};
  for (const auto& [name, thing] : kNames) {
    const std::vector<std::string> names = {name};
    EXPECT_EQ(ThingNamed(names), thing) << name;
  }
  const std::vector<std::string> street = {"Street 7"};
  EXPECT_EQ(ThingNamed(street), "");
}

TEST(Building, AStoreyWithoutSlabGetsItsFloorFromItsRoomsAndItsDoorsAThreshold) {
  const crossnav::test::TempFolder folder;
  const ImportReport report = Imported(folder.path(), std::nullopt);
  ASSERT_EQ(report.floors.size(), 1U);
  EXPECT_GT(report.area_m2, 26);  // of 36 in both rooms: the door is open, the bed is there
  EXPECT_TRUE(report.cut_off.empty());
  EXPECT_EQ(report.goals.at("bed"), 1);
  EXPECT_TRUE(HasNote(report, "'EG' has no slab; the outlines of its 2 rooms are its floor"));
  EXPECT_TRUE(HasNote(report, "1 inner doors get a threshold"));
  EXPECT_TRUE(HasNote(report, "1 inner 'Door' opened"));
}

TEST(Building, FurnishingAddsMissingPiecesAndTheSameSeedGivesTheSameBytes) {
  const crossnav::test::TempFolder a, b, c;
  const ImportReport first = Imported(a.path(), 3), second = Imported(b.path(), 3);
  EXPECT_EQ(first.goals.at("bed"), 1);  // there was one
  EXPECT_GE(first.goals.count("sofa") + first.goals.count("tv_monitor"), 1U);
  EXPECT_TRUE(first.cut_off.empty());
  for (const char* file : {"two.glb", "two.semantic.glb", "two.semantic.txt"}) {
    EXPECT_EQ(crossnav::test::ReadText(first.folder / file),
              crossnav::test::ReadText(second.folder / file));
  }
  const ImportReport other = Imported(c.path(), 4);
  EXPECT_NE(crossnav::test::ReadText(first.folder / "two.glb"),
            crossnav::test::ReadText(other.folder / "two.glb"));
}

TEST(Building, CutOffAndDamagedTextsAreErrorsThatNameTheFile) {
  const std::string whole = crossnav::test::TwoRooms();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const auto cut = ParseBuilding(whole.substr(0, length), "x.ifc");
    ASSERT_FALSE(cut.has_value()) << length;
    EXPECT_NE(cut.error().Message().find("x.ifc"), std::string::npos);
  }
  for (std::size_t i = 0; i < whole.size(); i += 11) {
    std::string damaged = whole;
    damaged[i] = damaged[i] == '9' ? '}' : '9';
    const auto parsed = ParseBuilding(damaged, "x.ifc");
    if (parsed) (void)MakeHome(*parsed);
  }
}

TEST(Building, WrongValuesNameTheirKey) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = crossnav::test::TwoRooms();
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
    const auto parsed = ParseBuilding(text, "x.ifc");
    return parsed ? std::string("read") : parsed.error().Message();
  };
  EXPECT_NE(with("\"format\":1", "\"format\":2").find("format"), std::string::npos);
  EXPECT_NE(with("[0,0],[4,0]", "[1e9,0],[4,0]").find("spaces[0].outline"), std::string::npos);
  EXPECT_NE(with("0,2,1,0,3,2", "0,2,99,0,3,2").find("elements[0].triangles"), std::string::npos);
  EXPECT_NE(with("\"wall\"", "\"hill\"").find("elements[0].kind"), std::string::npos);
  EXPECT_NE(with("\"wall_m\":[-4.2", "\"wall_m\":[4.2").find("wall_m"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::homes
