// SPDX-License-Identifier: MIT
#include "crossnav/world/house/house_generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/world/furniture/groups.h"
#include "crossnav/world/house/house_file.h"
#include "crossnav/world/house/house_gate.h"
#include "crossnav/world/layout/edition.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/shell/architecture.h"
#include "crossnav/world/stairs/stairs.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::world {
namespace {

TEST(HouseGenerator, WritesAHouseThatTheReaderAccepts) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 5;
  params.floors = 2;
  params.area_m2 = 90;
  const auto report = GenerateHouse(params, dir.path());
  ASSERT_TRUE(report.has_value()) << report.error().Message();
  EXPECT_EQ(report->floors, 2);
  EXPECT_GE(report->instances.size(), 5U);
  EXPECT_LT(report->bytes, EditionOf(params.edition).most_bytes);
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene.has_value()) << scene.error().Message();
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  ASSERT_TRUE(navmesh.has_value());
  EXPECT_GE(navmesh->Floors().size(), 2U);
  EXPECT_GE(navmesh->Connections().size(), 1U);
}

TEST(HouseGenerator, SameSeedGivesTheSameBytesAndAnotherSeedAnotherHouse) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 9;
  params.floors = 1;
  params.area_m2 = 70;
  const auto a = GenerateHouse(params, dir.path() / "a"),
             b = GenerateHouse(params, dir.path() / "b");
  ASSERT_TRUE(a && b);
  const std::string file = "House9.glb";
  EXPECT_EQ(test::ReadText(a->folder / file), test::ReadText(b->folder / file));
  params.seed = 10;
  const auto c = GenerateHouse(params, dir.path() / "c");
  ASSERT_TRUE(c.has_value());
  EXPECT_NE(test::ReadText(a->folder / file), test::ReadText(c->folder / "House10.glb"));
}

/// Regression: a sliver of a polygon hid the corner of a way, so that no way was found between
/// points of one piece of ground.
TEST(HouseGenerator, ConnectedPointsHaveAWay) {
  constexpr int kPoints = 60;
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 15;
  params.floors = 2;
  params.area_m2 = 120;
  const auto house = GenerateHouse(params, dir.path());
  ASSERT_TRUE(house) << house.error().Message();
  const auto scene = sim::LoadScene(house->folder);
  ASSERT_TRUE(scene) << scene.error().Message();
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  ASSERT_TRUE(navmesh);
  Rng rng(1);
  std::vector<Vector3d> connected_world;
  for (int i = 0; i < kPoints; ++i) {
    const auto p = navmesh->RandomPoint(rng);
    ASSERT_TRUE(p);
    if (connected_world.empty() || navmesh->Geodesic(connected_world.front(), *p))
      connected_world.push_back(*p);
  }
  ASSERT_GE(connected_world.size(), kPoints / 2);
  for (const Vector3d& a : connected_world)
    for (const Vector3d& b : connected_world)
      EXPECT_TRUE(navmesh->Geodesic(a, b)) << a.transpose() << " to " << b.transpose();
}

/// Houses from before the editions: named benchmarks use them. Hashes of meshes whose faces do not
/// overlap.
TEST(HouseGenerator, EditionOneDrawsUnchangedHouses) {
  struct Known {
    std::uint64_t seed;
    int floors;
    double area_m2;
    std::uint64_t mesh_hash;
  };
  for (const Known& known :
       {Known{1, 2, 80, 0x41e19085ae83507c}, Known{2, 2, 80, 0x092d00ee000b2dc1},
        Known{3, 1, 70, 0xa76c9642b64d87e3}}) {
    const test::TempFolder dir;
    HouseParams params;
    params.seed = known.seed;
    params.floors = known.floors;
    params.area_m2 = known.area_m2;
    const auto house = GenerateHouse(params, dir.path());
    ASSERT_TRUE(house) << house.error().Message();
    const auto scene = sim::LoadScene(house->folder);
    ASSERT_TRUE(scene) << scene.error().Message();
    EXPECT_EQ(scene->mesh_hash, known.mesh_hash) << "seed " << known.seed;
    params.edition = 2;
    params.has_lights = false;
    const auto other = GenerateHouse(params, dir.path() / "second");
    ASSERT_TRUE(other) << other.error().Message();
    EXPECT_NE(sim::LoadScene(other->folder)->mesh_hash, known.mesh_hash);
  }
}

TEST(HouseGenerator, EditionTwoHasTheShapesOfRealBuildings) {
  std::map<std::string, int> seen;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    HouseParams params;
    params.seed = seed;
    params.edition = 2;
    params.floors = 3;
    params.area_m2 = 150;
    const auto plan = DrawFurnishedPlan(params, 0);
    if (!plan) continue;  // the generator would draw another one
    for (const Stair& stair : plan->stairs) {
      ++seen[std::string(NameOf(stair.kind))];
      if (stair.riser_m > 0.22) ++seen["high riser"];
      const Vector2d tread = stair.treads[0].polygon[2] - stair.treads[0].polygon[0];
      if (tread.cwiseAbs().minCoeff() < 0.2) ++seen["narrow tread"];
    }
    for (const Wall& wall : plan->walls) {
      for (const Opening& o : wall.openings) {
        if (o.kind == OpeningKind::kWindow) continue;
        if (o.width_m < 0.7) ++seen["narrow door"];
        if (o.kind == OpeningKind::kDoorAjar && o.ajar_deg < 60) ++seen["leaf half open"];
        if (o.threshold_m > 0) ++seen["threshold"];
      }
    }
    for (const Block& block : plan->blocks) ++seen[block.name];
    for (const Room& room : plan->rooms) {
      ++seen[room.name];
      if (room.open_group >= 0) ++seen["open plan"];
    }
    for (const Placement& p : plan->furniture) {
      const Box3 box = BoxAt(p.model, p.T_world_object);
      if (p.model.name.find("plant") != std::string::npos && box.max.z() - box.min.z() < 0.41) {
        ++seen["small plant"];
      }
    }
  }
  for (const char* what : {"attic", "half turn of winders", "winder", "high riser", "narrow tread",
                           "narrow door", "leaf half open", "threshold", "wall", "column",
                           "ceiling", "mezzanine", "open plan", "small plant"}) {
    EXPECT_GT(seen[what], 0) << what;
  }
}

// Regression: of the 40 plans of seed 8, 38 had a door without a place, and no other passed.
TEST(HouseGenerator, EveryOfficeOfFourLargeFloorsHasAPlan) {
  HouseParams params;
  params.edition = 2;
  params.floors = 4;
  params.area_m2 = 250;
  params.building = Building::kOffice;
  for (params.seed = 1; params.seed <= 10; ++params.seed) {
    int attempt = 0;
    while (attempt < AttemptsFor(params) && !DrawFurnishedPlan(params, attempt, {})) ++attempt;
    EXPECT_LT(attempt, AttemptsFor(params) / 2) << params.seed;  // the rest is for other checks
  }
}

// Regression: with 160 MB for all houses of edition 2, another plan of seed 6036 passed, and the
// held-out set had another house.
TEST(HouseGenerator, HousesOfADrawnSizeKeepTheirLimitOfBytes) {
  EXPECT_EQ(MostBytesOf(1, 4 * 250), 40'000'000U);
  EXPECT_EQ(MostBytesOf(2, 4 * 240), 40'000'000U);
  EXPECT_EQ(MostBytesOf(2, 4 * 250), 160'000'000U);
}

TEST(HouseGenerator, AnOfficeIsACorridorOfManyRooms) {
  HouseParams params;
  params.edition = 2;
  params.building = Building::kOffice;
  params.floors = 4;
  params.area_m2 = 250;
  params.has_lights = false;
  params.has_textures = false;
  const test::TempFolder dir;
  const auto office = GenerateHouse(params, dir.path());
  ASSERT_TRUE(office) << office.error().Message();
  int rooms = 0;
  for (const auto& [name, count] : office->rooms) rooms += count;
  EXPECT_GT(rooms, 70);
  EXPECT_GT(office->rooms.at("office"), 30);
  EXPECT_EQ(office->floors, 4);
  params.edition = 1;
  EXPECT_EQ(GenerateHouse(params, dir.path()).error().where, "world.building");
}

/// A pack of one lamp of one colour.
FurniturePack PackOfOneLamp(const std::filesystem::path& dir) {
  PackModel m;
  m.entry.id = "Test#lamp";
  m.entry.kind = "ceiling lamp";
  m.entry.title = "A lamp";
  m.entry.author = "Somebody";
  m.entry.licence = "CC-BY 3.0";
  ModelBuilder b("ceiling lamp");
  b.Colour({1, 2, 3});
  b.mesh.AddBox({-0.1, -0.1, -0.3}, {0.1, 0.1, 0});
  m.model = b.Finish();
  EXPECT_TRUE(WritePack({m}, dir).has_value());
  return *FurniturePack::Load(dir);
}

TEST(HouseGenerator, FurnishesFromThePackAndCreditsIt) {
  const test::TempFolder dir;
  const FurniturePack pack = PackOfOneLamp(dir.path() / "pack");
  HouseParams params;
  params.seed = 5;
  params.floors = 1;
  params.area_m2 = 90;
  params.has_lights = false;
  const auto a = GenerateHouse(params, dir.path() / "a", &pack);
  const auto b = GenerateHouse(params, dir.path() / "b", &pack);
  const auto plain = GenerateHouse(params, dir.path() / "plain");
  ASSERT_TRUE(a && b && plain);
  for (const char* file : {"House5.glb", "House5.semantic.glb", "House5.house.json"}) {
    EXPECT_EQ(test::ReadText(a->folder / file), test::ReadText(b->folder / file)) << file;
  }
  EXPECT_NE(test::ReadText(a->folder / "House5.glb"), test::ReadText(plain->folder / "House5.glb"));
  const std::string text = test::ReadText(a->folder / "House5.house.json");
  EXPECT_NE(text.find("\"furniture_pack\": \"" + pack.hash() + "\""), std::string::npos);
  EXPECT_NE(text.find("\"author\": \"Somebody\""), std::string::npos);
  EXPECT_NE(test::ReadText(plain->folder / "House5.house.json").find("\"furniture_pack\": null"),
            std::string::npos);
}

TEST(HouseGenerator, AScanOfAHouseIsAnotherPictureOfTheSameHouse) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 5;
  params.floors = 1;
  params.area_m2 = 70;
  const auto clean = GenerateHouse(params, dir.path() / "clean");
  params.is_scan = true;
  const auto a = GenerateHouse(params, dir.path() / "a"),
             b = GenerateHouse(params, dir.path() / "b");
  ASSERT_TRUE(clean && a && b);
  EXPECT_EQ(test::ReadText(a->folder / "House5.glb"), test::ReadText(b->folder / "House5.glb"));
  EXPECT_NE(test::ReadText(a->folder / "House5.glb"), test::ReadText(clean->folder / "House5.glb"));
  EXPECT_EQ(a->instances, clean->instances);
  EXPECT_EQ(a->rooms, clean->rooms);
}

TEST(HouseGenerator, RoomsOfAHouseCanBeReadBack) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 5;
  params.floors = 1;
  params.area_m2 = 90;
  params.has_lights = false;
  const auto house = GenerateHouse(params, dir.path());
  ASSERT_TRUE(house.has_value());
  const auto rooms = ReadHouseRooms(house->folder);
  ASSERT_TRUE(rooms.has_value()) << rooms.error().Message();
  std::map<std::string, int> names;
  for (const HouseRoom& room : *rooms) ++names[room.name];
  EXPECT_EQ(names, house->rooms);
  EXPECT_TRUE(ReadHouseRooms(dir.path() / "00001-Other")->empty());
  std::ofstream(house->folder / "House5.house.json") << "{\"rooms\": [{\"name\": 3}]}";
  EXPECT_EQ(ReadHouseRooms(house->folder).error().code, ErrorCode::kMalformed);
}

TEST(HouseGenerator, AVariedHouseHasFurnitureOfOtherSizesInOtherPlaces) {
  FurnitureSource odd;
  odd.has_odd_sizes = true;
  std::size_t plain_pieces = 0, varied_pieces = 0;
  std::vector<double> plants_m;
  for (const std::uint64_t seed : {7, 8, 9, 10}) {
    HouseParams params;
    params.seed = seed;
    params.floors = 1;
    params.area_m2 = 70;
    const auto plain = DrawFurnishedPlan(params, 0, {});
    params.is_varied = true;
    const auto varied = DrawFurnishedPlan(params, 0, odd),
               again = DrawFurnishedPlan(params, 0, odd);
    ASSERT_TRUE(plain && varied && again);
    plain_pieces += plain->furniture.size();
    varied_pieces += varied->furniture.size();
    ASSERT_EQ(varied->furniture.size(), again->furniture.size());
    for (std::size_t i = 0; i < varied->furniture.size(); ++i) {
      const ObjectModel& model = varied->furniture[i].model;
      EXPECT_EQ(model.Size(), again->furniture[i].model.Size());
      if (model.name.find("plant") != std::string::npos) plants_m.push_back(model.Size().z());
    }
  }
  EXPECT_GT(varied_pieces, plain_pieces + 12);
  const auto [least_m, most_m] = std::minmax_element(plants_m.begin(), plants_m.end());
  ASSERT_TRUE(plants_m.size() > 2 && 2 * *least_m < *most_m) << "plants from small to large";
}

TEST(HouseGenerator, RefusesImpossibleWishes) {
  const test::TempFolder dir;
  HouseParams params;
  params.floors = 5;
  EXPECT_EQ(GenerateHouse(params, dir.path()).error().where, "world.floors");
  params.edition = 3;
  EXPECT_EQ(GenerateHouse(params, dir.path()).error().where, "world.edition");
  params.edition = 1;
  params.floors = 2;
  params.area_m2 = 30;
  EXPECT_EQ(GenerateHouse(params, dir.path()).error().where, "world.area_m2");
}

TEST(HouseGenerator, FurnitureKeepsDoorsFree) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    HouseParams params;
    params.seed = seed;
    params.edition = seed <= 4 ? 1 : 2;
    params.floors = 1;
    params.area_m2 = 100;
    const auto plan = DrawFurnishedPlan(params, 0);
    if (!plan) continue;  // this draw did not work out; the generator would take the next
    for (const Wall& wall : plan->walls) {
      for (const Opening& o : wall.openings) {
        if (o.kind == OpeningKind::kWindow) continue;
        const Vector2d c = wall.a + (wall.b - wall.a).normalized() * o.center_m;
        for (const Placement& p : plan->furniture) {
          const Box3 box = BoxAt(p.model, p.T_world_object);
          if (box.max.z() < 0.03 || box.min.z() > 2.05) continue;
          EXPECT_GT(box.HorizontalDistance({c.x(), c.y(), 0}), 0.3) << p.model.name;
        }
      }
    }
  }
}

/// A house of one room with a chair, a wall across it, or a second storey without a stair.
TEST(HouseGate, RefusesUnreachableRooms) {
  HouseParams params;
  params.seed = 5;
  params.floors = 2;
  params.area_m2 = 90;
  Result<HousePlan> plan = DrawFurnishedPlan(params, 0);
  for (int attempt = 1; !plan && attempt < 8; ++attempt) plan = DrawFurnishedPlan(params, attempt);
  ASSERT_TRUE(plan.has_value());
  const auto check = [](const HousePlan& p) {
    const sim::Scene scene = BuildHouse(p);
    const auto navmesh = sim::NavMesh::Build(scene, {});
    return CheckHouse(p, scene, *navmesh);
  };
  HousePlan no_stairs = *plan;
  no_stairs.stairs.clear();
  EXPECT_FALSE(check(no_stairs).has_value());

  HousePlan walled_up = *plan;
  for (Wall& wall : walled_up.walls) wall.openings.clear();
  EXPECT_FALSE(check(walled_up).has_value());

  HousePlan empty = *plan;
  empty.furniture.clear();
  EXPECT_EQ(check(empty).error().what, "fewer than five categories");

  HousePlan doubled = *plan;
  doubled.furniture.push_back(doubled.furniture.front());
  EXPECT_EQ(check(doubled).error().what, "furniture intersects");
}

// House 31 let the robot fall from the top floor into the one below, beside an open door.
TEST(HouseGenerator, NoTriangleOfTheNavMeshLeadsToAnotherFloor) {
  const test::TempFolder dir;
  HouseParams params;
  params.seed = 31;
  params.floors = 3;
  const auto report = GenerateHouse(params, dir.path());
  ASSERT_TRUE(report) << report.error().Message();
  const auto scene = sim::LoadScene(report->folder);
  ASSERT_TRUE(scene) << scene.error().Message();
  const sim::NavMeshSettings settings;
  const auto navmesh = sim::NavMesh::Build(*scene, settings);
  ASSERT_TRUE(navmesh) << navmesh.error().Message();
  const double slope = std::tan(DegToRad(settings.max_slope_deg));
  for (const auto& triangle : navmesh->Triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3f side = triangle.p_world[(k + 1) % 3] - triangle.p_world[k];
      EXPECT_LE(std::abs(side.z()),
                settings.max_climb_m + settings.cell_m + slope * side.head<2>().norm())
          << triangle.p_world[k].transpose();
    }
  }
}

}  // namespace
}  // namespace crossnav::world
