// SPDX-License-Identifier: MIT
// The nine example homes in Sweet Home 3D's own archive. They are not in this repository:
// CROSSNAV_SH3D_JAR names sweethome3d.jar; default is the place of Debian's package.
// CROSSNAV_LONG_TESTS=1 imports all nine, otherwise the homes with several floors.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/homes/scene_import.h"
#include "support/temp_folder.h"

namespace crossnav::homes {
namespace {

namespace fs = std::filesystem;

struct Example {
  const char* home;
  std::size_t floors;
  const char* goal;  ///< a category it must hold
};

constexpr Example kExamples[] = {
    {"2BedroomHouseWithBasement", 2, "toilet"},
    {"3BedroomHouseWithAttic", 3, "bed"},
    {"3BedroomHouseWithMezzanine", 2, "sofa"},
    {"1BedroomApartmentWithRoundWall", 1, "tv_monitor"},
    {"2BedroomApartment", 1, "sofa"},
    {"2BedroomApartmentWithBowWindow", 1, "bed"},
    {"3BedroomApartment", 1, "chair"},
    {"4BedroomHouse", 1, "plant"},
    {"Studio", 1, "toilet"},
};

fs::path Archive() {
  if (const char* jar = std::getenv("CROSSNAV_SH3D_JAR")) return jar;
  return "/usr/share/sweethome3d/sweethome3d.jar";
}

TEST(ExampleHomes, AllFloorsAreConnected) {
  if (!fs::exists(Archive())) {
    GTEST_SKIP() << "no " << Archive() << "; CROSSNAV_SH3D_JAR may name it";
  }
  const crossnav::test::TempFolder folder;
  const bool all = std::getenv("CROSSNAV_LONG_TESTS") != nullptr;
  for (const Example& example : kExamples) {
    if (!all && example.floors == 1) continue;
    ImportOptions options;
    options.input = Archive();
    options.home = example.home;
    options.out_dir = folder.path();
    const auto report = ImportScene(options);
    ASSERT_TRUE(report.has_value()) << report.error().Message();
    EXPECT_EQ(report->floors.size(), example.floors) << example.home;
    EXPECT_TRUE(report->cut_off.empty()) << example.home;
    for (const Storey& storey : report->storeys) {
      EXPECT_TRUE(storey.is_reached) << example.home << " " << storey.name;
    }
    EXPECT_GT(report->goals.count(example.goal), 0U) << example.home;
    for (const std::string& note : report->notes) {
      EXPECT_EQ(note.find("as a box"), note.npos) << note;
    }
  }
}

TEST(ExampleHomes, AnArchiveOfSeveralHomesAsksWhichOne) {
  if (!fs::exists(Archive())) {
    GTEST_SKIP() << "no " << Archive() << "; CROSSNAV_SH3D_JAR may name it";
  }
  ImportOptions options;
  options.input = Archive();
  const auto report = ImportScene(options);
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().what.find("--home: 1BedroomApartmentWithRoundWall"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::homes
