// SPDX-License-Identifier: MIT
// A home built in code is imported, read back by the reader of HM3D's files, and walked through.
#include "crossnav/homes/scene_import.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "home_maker.h"
#include "support/temp_folder.h"

namespace crossnav::homes {
namespace {

namespace fs = std::filesystem;
using test::Entries;
using test::TwoStoreyHome;
using test::With;

class SceneImport : public testing::Test {
 protected:
  Result<ImportReport> Import(const Entries& entries, const std::string& name = "") {
    ImportOptions options;
    options.input = test::WriteArchive(folder_.path() / "My home.sh3d", entries);
    options.out_dir = folder_.path() / "scenes";
    options.name = name;
    return ImportScene(options);
  }

  static bool HasNote(const ImportReport& report, const std::string& part) {
    return std::any_of(report.notes.begin(), report.notes.end(),
                       [&](const std::string& n) { return n.find(part) != n.npos; });
  }

  static const sim::SceneInstance* Named(const sim::Scene& scene, const std::string& name) {
    for (const auto& instance : scene.instances) {
      if (instance.name == name) return &instance;
    }
    return nullptr;
  }

  crossnav::test::TempFolder folder_;
};

TEST_F(SceneImport, AHomeOfTwoStoreysBecomesASceneWithBothFloorsConnected) {
  const auto report = Import(TwoStoreyHome());
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_EQ(report->scene_id, "00001-My_home");
  EXPECT_EQ(report->levels, 2);
  EXPECT_EQ(report->rooms, 3);
  ASSERT_EQ(report->floors.size(), 2U);
  EXPECT_NEAR(report->floors[1].height_m - report->floors[0].height_m, 2.62, 0.1);
  EXPECT_EQ(report->connections.size(), 1U);
  EXPECT_TRUE(report->cut_off.empty());
  ASSERT_EQ(report->storeys.size(), 2U);
  EXPECT_TRUE(report->storeys[0].is_reached && report->storeys[1].is_reached);
  EXPECT_FALSE(HasNote(*report, "staircase")) << "its own steps can be climbed";
  for (const char* file : {"My_home.glb", "My_home.semantic.glb", "My_home.semantic.txt"}) {
    EXPECT_TRUE(fs::exists(report->folder / file)) << file;
  }
  EXPECT_TRUE(fs::exists(folder_.path() / "scenes/crossnav.scene_dataset_config.json"));
}

TEST_F(SceneImport, PiecesStandWhereThePlanHasThemAndCarryRawNames) {
  const auto report = Import(TwoStoreyHome());
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  const auto* bed = Named(*scene, "double bed");
  ASSERT_NE(bed, nullptr);
  EXPECT_EQ(bed->category, "bed");
  EXPECT_NEAR((bed->box.min - Vector3d(4.3, -2.2, 2.62)).norm(), 0, 0.01);
  EXPECT_NEAR((bed->box.max - Vector3d(5.7, -0.2, 3.22)).norm(), 0, 0.01);
  const auto* chair = Named(*scene, "wooden chair");
  ASSERT_NE(chair, nullptr) << "a red wooden chair is a wooden chair";
  EXPECT_EQ(chair->category, "chair");
  EXPECT_TRUE(HasNote(*report, "'Red wooden chair' is shown as a box"));
  for (const char* name : {"wall", "floor", "ceiling", "stairs", "door", "window"}) {
    EXPECT_NE(Named(*scene, name), nullptr) << name;
  }
  EXPECT_EQ(report->goals.at("bed"), 1);
}

TEST_F(SceneImport, ColoursOfThePlanAreSeen) {
  const auto report = Import(TwoStoreyHome());
  ASSERT_TRUE(report.has_value());
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value());
  const auto colour_of = [&](const std::string& name) {
    for (std::size_t t = 0; t < scene->mesh.triangles.size(); ++t) {
      const auto* instance = scene->FindInstance(scene->mesh.triangle_instance[t]);
      if (instance && instance->name == name) {
        return scene->materials[scene->mesh.triangle_material[t]].colour;
      }
    }
    return Rgb8{};
  };
  EXPECT_EQ(colour_of("floor"), (Rgb8{0x80, 0x90, 0xA0}));
  EXPECT_EQ(colour_of("double bed"), (Rgb8{0x20, 0x40, 0x80}));
}

TEST_F(SceneImport, InnerDoorsStandOpenAndWallsHaveHolesOnlyWhereOpeningsAre) {
  const auto report = Import(TwoStoreyHome());
  ASSERT_TRUE(report.has_value());
  EXPECT_TRUE(HasNote(*report, "inner 'Door' opened"));
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value());
  const sim::RayCaster caster(*scene);
  const auto distance = [&](const Vector3d& from, const Vector3d& to) {
    const auto hit = caster.Cast(from, (to - from).normalized(), 20);
    return hit ? hit->distance_m : 1e9;
  };
  // Through the door and into the far wall; beside it and above it into the inner wall.
  EXPECT_NEAR(distance({2.5, -4, 1}, {6, -4, 1}), 3.5, 0.02);
  EXPECT_NEAR(distance({2.5, -3, 1}, {6, -3, 1}), 0.95, 0.02);
  EXPECT_NEAR(distance({2.5, -4, 2.3}, {6, -4, 2.3}), 0.95, 0.02);
  // Below and above the window the outer wall is closed.
  EXPECT_NEAR(distance({2, -4, 0.5}, {2, -6, 0.5}), 1, 0.02);
  EXPECT_NEAR(distance({2, -4, 2.3}, {2, -6, 2.3}), 1, 0.02);
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  ASSERT_TRUE(navmesh.has_value());
  const auto way = navmesh->Geodesic({2.5, -2.5, 0}, {5, -2.5, 0});
  ASSERT_TRUE(way.has_value());
  EXPECT_GT(*way, 3.5) << "round by the door";
  EXPECT_LT(*way, 6.0);
}

TEST_F(SceneImport, AStaircaseThatCannotBeClimbedIsReplacedByAPlainFlight) {
  Entries ladder = TwoStoreyHome();
  ladder["0"] = test::ObjBox(1, -45, 0, -140, 45, 362, 140);  // a closed box
  const auto report = Import(ladder);
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_TRUE(HasNote(*report, "'Staircase' cannot be climbed as drawn and is replaced"));
  ASSERT_EQ(report->floors.size(), 2U);
  EXPECT_EQ(report->connections.size(), 1U);
  EXPECT_TRUE(report->storeys[1].is_reached);
}

TEST_F(SceneImport, ANarrowShaftGetsASpiral) {
  Entries spiral = With(TwoStoreyHome(), "x='60' y='200' width='90' depth='280'",
                        "x='150' y='200' width='160' depth='160'");
  spiral["0"] = test::ObjBox(1, -45, 0, -140, 45, 362, 140);
  const auto report = Import(spiral);
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_TRUE(HasNote(*report, "is replaced"));
  EXPECT_EQ(report->connections.size(), 1U);
}

TEST_F(SceneImport, AnUnreachableFloorIsReportedAndStillImported) {
  const auto report = Import(With(TwoStoreyHome(), "staircaseCutOutShape='M0,0 v1 h1 v-1 z'", ""));
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  ASSERT_EQ(report->storeys.size(), 2U);
  EXPECT_NE(report->storeys[0].is_reached, report->storeys[1].is_reached);
  const auto too_small =
      Import(With(TwoStoreyHome(), "width='90' depth='280'", "width='30' depth='30'"));
  ASSERT_TRUE(too_small.has_value()) << too_small.error().Message();
  EXPECT_TRUE(HasNote(*too_small, "no flight in its box leads up"));
}

TEST_F(SceneImport, HiddenLevelsAndPiecesAreLeftOut) {
  Entries hidden = With(TwoStoreyHome(), "visible='false'", "viewable='false'");
  const auto report = Import(With(hidden, "name='Door' model='1'", "name='Door' visible='false'"));
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_EQ(report->rooms, 2);
  EXPECT_EQ(report->goals.count("bed"), 0U);
  EXPECT_TRUE(HasNote(*report, "level 'Upper' is hidden"));
  EXPECT_FALSE(HasNote(*report, "inner 'Door'"));
}

TEST_F(SceneImport, WallsWithoutRoomsStillHaveAFloor) {
  Entries entries = TwoStoreyHome();
  std::string& xml = entries["Home.xml"];
  xml = xml.substr(0, xml.find("<room")) + "</home>";
  const auto report = Import(entries);
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_TRUE(HasNote(*report, "'Ground' has walls and no rooms"));
  EXPECT_EQ(report->floors.size(), 2U);
  EXPECT_EQ(report->connections.size(), 1U);
}

TEST_F(SceneImport, ImportingAgainReplacesTheSceneAndOthersGetTheNextNumber) {
  ASSERT_TRUE(Import(TwoStoreyHome()).has_value());
  const auto again = Import(TwoStoreyHome());
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->scene_id, "00001-My_home");
  const auto other = Import(TwoStoreyHome(), "Other");
  ASSERT_TRUE(other.has_value());
  EXPECT_EQ(other->scene_id, "00002-Other");
  const auto chosen = Import(TwoStoreyHome(), "00123-Chosen");
  ASSERT_TRUE(chosen.has_value());
  EXPECT_EQ(chosen->scene_id, "00123-Chosen");
  EXPECT_EQ(again->bytes, other->bytes);
}

TEST_F(SceneImport, TheSameHomeGivesTheSameBytes) {
  const auto a = Import(TwoStoreyHome(), "A");
  const auto b = Import(TwoStoreyHome(), "B");
  ASSERT_TRUE(a && b);
  const auto first = sim::LoadScene(a->folder), second = sim::LoadScene(b->folder);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->mesh_hash, second->mesh_hash);
}

}  // namespace
}  // namespace crossnav::homes
