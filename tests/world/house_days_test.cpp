// SPDX-License-Identifier: MIT
#include "crossnav/world/change/house_days.h"

#include <gtest/gtest.h>

#include <fstream>

#include "crossnav/world/change/changes.h"
#include "crossnav/world/change/day_gate.h"
#include "crossnav/world/change/scene_edit.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/scene/scene_writer.h"
#include "crossnav/world/shell/scene_builder.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::world {
namespace {

/// Instances made of boxes.
class BoxHouse {
 public:
  int Add(const char* name, int region, const Vector3d& min, const Vector3d& max, Rgb8 colour) {
    const int id = builder_.BeginInstance(name, region);
    builder_.mesh.material = builder_.Material(colour);
    builder_.mesh.AddBox(min, max);
    return id;
  }
  void Wall(const Vector3d& min, const Vector3d& max) { Add("wall", 0, min, max, {230, 230, 220}); }
  void Floor(int region, double x0, double y0, double x1, double y1, double z = 0) {
    Add("floor", region, {x0, y0, z - 0.2}, {x1, y1, z}, {150, 120, 90});
  }
  /// Table of .7 m; returns its instance.
  int Table(int region, double x, double y, double z = 0) {
    const int id = builder_.BeginInstance("table", region);
    builder_.mesh.material = builder_.Material({120, 80, 50});
    builder_.mesh.AddBox({x - 0.6, y - 0.4, z + 0.66}, {x + 0.6, y + 0.4, z + 0.7});
    for (const double dx : {-0.55, 0.5}) {
      for (const double dy : {-0.35, 0.3}) {
        builder_.mesh.AddBox({x + dx, y + dy, z}, {x + dx + 0.05, y + dy + 0.05, z + 0.66});
      }
    }
    return id;
  }
  int Chair(int region, double x, double y, double z = 0) {
    return Add("chair", region, {x - 0.2, y - 0.2, z}, {x + 0.2, y + 0.2, z + 0.8}, {40, 90, 160});
  }
  sim::Scene Finish() {
    sim::Scene scene = builder_.Finish("00001-Ring");
    sim::UpdateDerived(scene);
    return scene;
  }

 private:
  SceneBuilder builder_;
};

constexpr double kDoor_m = 0.9;

/// Wall along x = `x` (or y) from `a` to `b` with a doorway around `door`; none where door < 0.
void WallX(BoxHouse& house, double x, double a, double b, double door) {
  if (door < 0) return house.Wall({x - 0.05, a, 0}, {x + 0.05, b, 2.5});
  house.Wall({x - 0.05, a, 0}, {x + 0.05, door - kDoor_m / 2, 2.5});
  house.Wall({x - 0.05, door + kDoor_m / 2, 0}, {x + 0.05, b, 2.5});
}
void WallY(BoxHouse& house, double y, double a, double b, double door) {
  if (door < 0) return house.Wall({a, y - 0.05, 0}, {b, y + 0.05, 2.5});
  house.Wall({a, y - 0.05, 0}, {door - kDoor_m / 2, y + 0.05, 2.5});
  house.Wall({door + kDoor_m / 2, y - 0.05, 0}, {b, y + 0.05, 2.5});
}

/// Three rooms in a ring: 0 left, 1 right below, 2 right above. The doorway 0 - 1 has an open leaf.
/// `boxed_in`: a sofa stands in a closed box of walls, so that nobody can see it. `slit_m`: width
/// of the only way to room 1.
sim::Scene RingHouse(bool boxed_in = false, double slit_m = 0) {
  BoxHouse house;
  house.Floor(0, 0, 0, 4, 8);
  house.Floor(1, 4, 0, 8, 4);
  house.Floor(2, 4, 4, 8, 8);
  WallX(house, 0, 0, 8, -1);
  WallX(house, 8, 0, 8, -1);
  WallY(house, 0, 0, 8, -1);
  WallY(house, 8, 0, 8, -1);
  WallX(house, 4, 0, 4, 2);
  WallX(house, 4, 4, 8, 6);
  WallY(house, 4, 4, 8, 6);
  house.Add("door", 0, {3.05, 2.45, 0}, {3.95, 2.49, 2.0}, {206, 190, 164});
  const int table = house.Table(0, 1.5, 4);
  EXPECT_GT(table, 0);
  house.Table(0, 1.5, 7);
  house.Table(1, 6, 1);
  house.Table(2, 6, 7);
  house.Chair(0, 1.5, 3.2);
  house.Chair(2, 4.8, 7.4);
  house.Add("vase", 0, {1.2, 3.8, 0.7}, {1.35, 3.95, 1.0}, {200, 60, 60});
  house.Add("plant", 1, {7.2, 3.2, 0}, {7.5, 3.5, 1.0}, {50, 140, 60});
  house.Add("plant", 2, {7.2, 4.5, 0}, {7.5, 4.8, 1.0}, {50, 140, 60});
  house.Add("toilet", 1, {4.3, 3.3, 0}, {4.7, 3.8, 0.5}, {250, 250, 250});
  if (boxed_in) {
    house.Add("sofa", 2, {5.0, 5.0, 0}, {5.4, 5.4, 0.5}, {90, 90, 90});
    WallX(house, 4.9, 4.9, 5.5, -1);
    WallX(house, 5.5, 4.9, 5.5, -1);
    WallY(house, 4.9, 4.9, 5.5, -1);
    WallY(house, 5.5, 4.9, 5.5, -1);
    house.Wall({4.85, 4.85, 0.6}, {5.55, 5.55, 0.7});
  }
  if (slit_m > 0) {
    house.Wall({5.55, 3.95, 0}, {6.45, 4.05, 2.5});
    house.Wall({3.95, 1.5, 0}, {4.05, 2.45 - slit_m, 2.5});
  }
  return house.Finish();
}

/// Two terraces with two flights between them.
sim::Scene TwoFlights() {
  BoxHouse house;
  house.Floor(0, 0, 0, 4, 6);
  house.Floor(1, 6.8, 0, 11, 6, 2);
  for (const double y : {0.5, 4.5}) {
    int id = 0;
    for (int step = 0; step < 10; ++step) {
      const double x = 4 + 0.28 * step;
      const Vector3d min(x, y, -0.2), max(x + 0.28, y + 1, 0.2 * (step + 1));
      id = house.Add("stairs", 0, min, max, {170, 140, 100});
    }
    EXPECT_GT(id, 0);
    house.Wall({4, y - 0.1, -0.2}, {6.8, y, 3});
    house.Wall({4, y + 1, -0.2}, {6.8, y + 1.1, 3});
  }
  house.Wall({6.7, 0, 0}, {6.8, 0.4, 3});
  house.Table(0, 2, 3);
  house.Table(1, 9, 3, 2);
  house.Chair(0, 2, 2.2);
  sim::Scene scene = house.Finish();
  // The steps of a flight are one instance.
  int first = 0;
  for (auto& instance : scene.instances) {
    if (instance.name != "stairs") continue;
    const bool is_first_step = instance.box.max.z() < 0.25;
    if (is_first_step) first = instance.id;
    for (auto& of_triangle : scene.mesh.triangle_instance) {
      if (of_triangle == instance.id) of_triangle = first;
    }
  }
  std::erase_if(scene.instances, [&](const auto& instance) {
    return instance.name == "stairs" && instance.box.max.z() > 0.25;
  });
  sim::UpdateDerived(scene);
  return scene;
}

DaysOptions Options(std::vector<ChangeKind> kinds, std::uint64_t seed = 1) {
  DaysOptions options;
  options.seed = seed;
  options.kinds = std::move(kinds);
  options.navmesh.cell_m = 0.08;  // coarse, so that a day takes no time
  options.navmesh.cell_height_m = 0.05;
  return options;
}

HouseDay DayOf(sim::Scene scene, const DaysOptions& options) {
  auto calendar = HouseCalendar::Begin(std::move(scene), options);
  EXPECT_TRUE(calendar.has_value()) << (calendar ? "" : calendar.error().Message());
  auto day = calendar->Next();
  EXPECT_TRUE(day.has_value()) << (day ? "" : day.error().Message());
  return day ? std::move(*day) : HouseDay{};
}

TEST(HouseDays, EveryKindOfMoveIsWhatTheListSays) {
  const sim::Scene first = RingHouse();
  const HouseDay day = DayOf(first, Options({ChangeKind::kSameFurniture,
                                             ChangeKind::kOtherFurniture, ChangeKind::kOtherRoom}));
  ASSERT_EQ(day.list.changes.size(), 3U);
  for (const Change& change : day.list.changes) {
    ASSERT_TRUE(change.from && change.to);
    const auto* before = first.FindInstance(change.instance);
    const auto* after = day.scene.FindInstance(change.instance);
    ASSERT_TRUE(before != nullptr && after != nullptr);
    EXPECT_NE(change.name, "toilet");
    EXPECT_NE(change.name, "table");
    EXPECT_LT((before->box.Center() - change.from->box.Center()).norm(), 0.01);
    EXPECT_LT((after->box.Center() - change.to->box.Center()).norm(), 0.01);
    const bool same_room = change.from->room == change.to->room;
    EXPECT_EQ(same_room, change.kind != ChangeKind::kOtherRoom) << NameOf(change.kind);
    if (change.kind == ChangeKind::kSameFurniture) {
      EXPECT_EQ(change.from->support, change.to->support);
    }
    if (change.kind == ChangeKind::kOtherFurniture) {
      EXPECT_NE(change.from->support, change.to->support);
    }
  }
}

TEST(HouseDays, WhatTheListDoesNotNameStaysWhereItWas) {
  const test::TempFolder dir;
  const sim::Scene first = RingHouse();
  const auto house = WriteScene(first, dir.path());
  ASSERT_TRUE(house.has_value());
  DaysOptions options = Options({ChangeKind::kOtherRoom, ChangeKind::kAdded, ChangeKind::kRemoved});
  options.days = 2;
  const auto days = WriteDays(*house, {}, options);
  ASSERT_TRUE(days.has_value()) << days.error().Message();
  ASSERT_EQ(days->size(), 2U);
  EXPECT_EQ(days->front().folder.filename(), "00001-Ring-day1");
  sim::Scene before = first;
  for (const DayReport& report : *days) {
    const auto scene = sim::LoadScene(report.folder);
    ASSERT_TRUE(scene.has_value()) << scene.error().Message();
    const auto list = ReadChanges(report.folder);
    ASSERT_TRUE(list.has_value()) << list.error().Message();
    std::set<int> changed;
    for (const Change& change : list->changes) {
      changed.insert(change.instance);
      const auto* now = scene->FindInstance(change.instance);
      if (change.kind == ChangeKind::kRemoved) {
        EXPECT_EQ(now, nullptr);
        continue;
      }
      ASSERT_NE(now, nullptr);
      ASSERT_FALSE(now->box.empty()) << change.name << " has no triangles";
      EXPECT_LT((now->box.Center() - change.to->box.Center()).norm(), 0.01);
    }
    for (const auto& instance : scene->instances) {
      if (changed.contains(instance.id)) continue;
      const auto* was = before.FindInstance(instance.id);
      ASSERT_NE(was, nullptr) << instance.name;
      EXPECT_LT((was->box.Center() - instance.box.Center()).norm(), 0.001) << instance.name;
    }
    before = *scene;
  }
}

TEST(HouseDays, AClosedDoorLeavesAWayAroundAndOpensTheNextDay) {
  const sim::Scene first = RingHouse();
  auto calendar = HouseCalendar::Begin(first, Options({ChangeKind::kDoorClosed}));
  ASSERT_TRUE(calendar.has_value());
  const auto day = calendar->Next();
  ASSERT_TRUE(day.has_value()) << day.error().Message();
  ASSERT_EQ(day->list.changes.size(), 1U);
  EXPECT_EQ(day->list.changes[0].name, "door");
  const auto open = sim::NavMesh::Build(first, Options({}).navmesh);
  const auto shut = sim::NavMesh::Build(day->scene, Options({}).navmesh);
  ASSERT_TRUE(open && shut);
  const Vector3d a(3, 1.2, 0), b(5, 2, 0);
  EXPECT_LT(*open->Geodesic(a, b), 3);
  ASSERT_TRUE(shut->Geodesic(a, b).has_value());
  EXPECT_GT(*shut->Geodesic(a, b), 6);
  const auto next = calendar->Next();
  ASSERT_TRUE(next.has_value());
  ASSERT_EQ(next->list.lifted.size(), 1U);
  EXPECT_EQ(next->list.lifted[0].instance, day->list.changes[0].instance);
}

TEST(HouseDays, APassageIsBlockedWhereNoDoorHangs) {
  const HouseDay day = DayOf(RingHouse(), Options({ChangeKind::kPassageBlocked}));
  ASSERT_EQ(day.list.changes.size(), 1U);
  EXPECT_EQ(day.list.changes[0].name, "barrier");
  const auto navmesh = sim::NavMesh::Build(day.scene, Options({}).navmesh);
  ASSERT_TRUE(navmesh.has_value());
  EXPECT_TRUE(navmesh->Geodesic({1, 1, 0}, {7, 7.5, 0}).has_value());
}

TEST(HouseDays, AThingIsCarriedToAnotherFloor) {
  const HouseDay day = DayOf(TwoFlights(), Options({ChangeKind::kOtherFloor}));
  ASSERT_EQ(day.list.changes.size(), 1U);
  EXPECT_EQ(day.list.changes[0].from->floor, 0);
  EXPECT_EQ(day.list.changes[0].to->floor, 1);
  EXPECT_GT(day.list.changes[0].to->p_world.z(), 1.9);
}

TEST(HouseDays, OnlyTheOneInstanceOfItsCategoryChangesWhereThatIsAsked) {
  DaysOptions options = Options({ChangeKind::kOtherFurniture});
  const HouseDay by_name = DayOf(RingHouse(), options);
  ASSERT_EQ(by_name.list.changes.size(), 1U);
  EXPECT_EQ(by_name.list.changes[0].name, "vase");  // the only object with a name of its own
  options.only_by_category = true;
  const HouseDay none = DayOf(RingHouse(), options);
  EXPECT_TRUE(none.list.changes.empty());
  EXPECT_EQ(none.missing, options.kinds);
  options.kinds = {ChangeKind::kOtherFloor};
  const HouseDay chair = DayOf(TwoFlights(), options);
  ASSERT_EQ(chair.list.changes.size(), 1U);
  EXPECT_EQ(chair.list.changes[0].category, "chair");
}

TEST(HouseDays, OneInstanceOfEachCategoryThatPeopleMoveStaysWhereThatIsAsked) {
  sim::Scene scene = RingHouse();
  const auto count = [&](const char* category) {
    return std::count_if(scene.instances.begin(), scene.instances.end(),
                         [&](const auto& i) { return i.category == category; });
  };
  ASSERT_EQ(count("chair"), 2);
  ASSERT_EQ(count("plant"), 2);
  const std::size_t before = scene.instances.size();
  ASSERT_TRUE(KeepOneOfEachCategory(scene, Options({}).navmesh));
  EXPECT_EQ(count("chair"), 1);
  EXPECT_EQ(count("plant"), 1);
  EXPECT_EQ(scene.instances.size(), before - 2);
}

TEST(HouseDays, AFlightIsBarredOnlyWhereAnotherLeadsUp) {
  const HouseDay day = DayOf(TwoFlights(), Options({ChangeKind::kFlightBarred}));
  ASSERT_EQ(day.list.changes.size(), 1U);
  const auto navmesh = sim::NavMesh::Build(day.scene, Options({}).navmesh);
  ASSERT_TRUE(navmesh.has_value());
  const bool is_first_barred = day.list.changes[0].to->p_world.y() < 3;
  const double y = is_first_barred ? 1 : 5;
  EXPECT_GT(*navmesh->Geodesic({3.5, y, 0}, {7.2, y, 2}), 8);

  sim::Scene one = TwoFlights();
  for (const auto& instance : TwoFlights().instances) {
    if (instance.name == "stairs" && instance.box.min.y() > 3) RemoveInstance(one, instance.id);
  }
  Settle(one);
  const HouseDay only = DayOf(one, Options({ChangeKind::kFlightBarred}));
  EXPECT_TRUE(only.list.changes.empty());
  EXPECT_EQ(only.missing, std::vector<ChangeKind>{ChangeKind::kFlightBarred});
}

TEST(HouseDays, TheSameSeedGivesTheSameBytesAndAnotherSeedAnotherDay) {
  const auto text = [](std::uint64_t seed) {
    const HouseDay day =
        DayOf(RingHouse(), Options({ChangeKind::kOtherRoom, ChangeKind::kRemoved}, seed));
    return ChangesText(day.list) + EncodeRenderGlb(day.scene) + EncodeSemanticGlb(day.scene);
  };
  EXPECT_EQ(text(3), text(3));
  EXPECT_NE(text(3), text(4));
}

TEST(HouseDays, TheGateRefusesADayThatLosesACategory) {
  sim::Scene scene = RingHouse();
  for (const auto& instance : RingHouse().instances) {
    // The vase and one chair are left: to remove the chair would leave no chair.
    if (instance.name == "plant" || instance.name == "vase") RemoveInstance(scene, instance.id);
    if (instance.name == "chair" && instance.box.min.x() > 4) RemoveInstance(scene, instance.id);
  }
  Settle(scene);
  auto calendar = HouseCalendar::Begin(scene, Options({ChangeKind::kRemoved}));
  ASSERT_TRUE(calendar.has_value());
  const auto day = calendar->Next();
  ASSERT_FALSE(day.has_value());
  EXPECT_NE(day.error().Message().find("fewer than five categories"), std::string::npos);
  DaysOptions fewer = Options({ChangeKind::kRemoved});
  fewer.may_be_fewer = true;
  auto again = HouseCalendar::Begin(scene, fewer);
  ASSERT_TRUE(again.has_value());
  const auto quiet = again->Next();
  ASSERT_TRUE(quiet.has_value()) << quiet.error().Message();
  EXPECT_TRUE(quiet->list.changes.empty());
  EXPECT_EQ(quiet->missing, std::vector<ChangeKind>{ChangeKind::kRemoved});
}

/// Regression: a couch was put so that the way to the rest of a house was a few centimetres wider
/// than the body; agents went in and never got out.
TEST(HouseDays, AWayAsNarrowAsTheBodyIsNone) {
  const DaysOptions options = Options({});
  const sim::Scene first = RingHouse();
  const auto view = ViewHouse(first, options.navmesh);
  const auto before = sim::NavMesh::Build(first, WithRoomToSpare(options.navmesh));
  ASSERT_TRUE(view && before);
  for (const double slit_m : {0.5, 0.85}) {
    const sim::Scene later = RingHouse(false, slit_m);
    const auto body = sim::NavMesh::Build(later, options.navmesh);
    const auto spare = sim::NavMesh::Build(later, WithRoomToSpare(options.navmesh));
    ASSERT_TRUE(body && spare);
    EXPECT_TRUE(body->Geodesic({1, 1, 0}, {7, 1, 0}).has_value()) << "the body fits";
    const auto ok = CheckWays(*view, *before, *spare, {});
    EXPECT_EQ(ok.has_value(), slit_m > 0.6) << slit_m;
    const std::string reason = ok ? "" : ok.error().Message();
    EXPECT_EQ(reason.find("as narrow as the body") != std::string::npos, !ok) << reason;
    EXPECT_TRUE(CheckWays(*view, *spare, *spare, {}).has_value()) << "it was so before";
  }
}

/// Regression: in a home that people drew no way leads from the largest room to the beds and the
/// toilet; it had no later days.
TEST(HouseDays, ACategoryThatCouldNotBeSeenOnTheFirstDayNeedNotBeSeenLater) {
  auto calendar = HouseCalendar::Begin(RingHouse(true), Options({ChangeKind::kSameFurniture}));
  ASSERT_TRUE(calendar.has_value());
  const auto day = calendar->Next();
  ASSERT_TRUE(day.has_value()) << day.error().Message();
  EXPECT_EQ(day->list.changes.size(), 1U);
}

TEST(HouseDays, AHouseWithoutNamesOrThatIsNotThereIsAnError) {
  const test::TempFolder dir;
  EXPECT_FALSE(WriteDays(dir.path() / "00001-None", {}, Options({})).has_value());
  sim::Scene nameless = RingHouse();
  nameless.instances.clear();
  const auto calendar = HouseCalendar::Begin(nameless, Options({}));
  ASSERT_FALSE(calendar.has_value());
  EXPECT_NE(calendar.error().Message().find("semantic"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::world
