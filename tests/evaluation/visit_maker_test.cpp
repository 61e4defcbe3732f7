// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visit_maker.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "sim/micro_scene.h"

namespace crossnav::evaluation {
namespace {

/// A room with five objects that have a name of their own, and two of each of three categories.
/// `kept`: of the objects, the stool is there; `shut`: walls are around its place.
std::unique_ptr<SceneContext> Room(bool kept = true, bool shut = false) {
  sim::test::MicroScene micro;
  micro.Room(0, 0, 12, 6);
  int place = 0;
  const auto add = [&](const std::string& name, const char* category) {
    if (name == "stool" && !kept) return ++place;
    const Vector3d p(1.0 + 2.0 * (place % 6), place < 6 ? 0.5 : 5.0, 0);
    micro.Begin(name, category);
    micro.Box(p, p + Vector3d(0.5, 0.5, 0.9));
    return ++place;
  };
  for (const char* name : {"floor lamp", "desk", "stool", "bench", "refrigerator"}) add(name, "");
  for (const char* category : {"chair", "bed", "toilet", "chair", "bed", "toilet"})
    add(category, category);
  if (shut) {
    micro.Begin("wall", "");
    micro.Box(Vector3d(3.6, 0, 0), Vector3d(3.7, 3, 2));
    micro.Box(Vector3d(6.8, 0, 0), Vector3d(6.9, 3, 2));
    micro.Box(Vector3d(3.6, 2.9, 0), Vector3d(6.9, 3, 2));
  }
  auto context = SceneContext::Of(micro.Finish(), {});
  EXPECT_TRUE(context) << context.error().Message();
  return std::move(*context);
}

TEST(VisitMaker, GoalsThatStayedHaveANameOfTheirOwnBeforeOthersAreTaken) {
  std::vector<VisitDay> days(2);
  for (int day = 0; day < 2; ++day) {
    days[static_cast<std::size_t>(day)].context = Room();
    days[static_cast<std::size_t>(day)].scene_id = day == 0 ? "micro" : "micro-day1";
  }
  const auto visits = MakeVisits(days, 1);
  ASSERT_TRUE(visits) << visits.error().Message();
  std::set<std::string> goals;
  for (const VisitGoal& goal : visits->back().goals) {
    EXPECT_EQ(goal.track, "static");
    goals.insert(goal.goal);
  }
  EXPECT_EQ(goals, (std::set<std::string>{"floor lamp", "desk", "stool", "bench", "refrigerator"}));
  EXPECT_TRUE(CheckVisit(*days[1].context, visits->back()).empty());
}

/// Regression: a search for what had been removed from a room that a door shut overnight could not
/// end well: nobody can tell that it is gone.
TEST(VisitMaker, WhatWasRemovedIsAGoalWhereItsOldPlaceCanBeReached) {
  const auto goals_with = [](bool shut) {
    std::vector<VisitDay> days(2);
    days[0].context = Room();
    days[1].context = Room(false, shut);
    days[0].scene_id = "micro";
    days[1].scene_id = "micro-day1";
    world::Change change;
    change.kind = world::ChangeKind::kRemoved;
    change.name = "stool";
    change.from = world::ChangePlace{Vector3d(5.25, 0.75, 0), {}, 0, 0, 0};
    days[1].list.changes.push_back(change);
    const auto visits = MakeVisits(days, 1);
    EXPECT_TRUE(visits) << visits.error().Message();
    std::set<std::string> absent;
    for (const VisitGoal& goal : visits->back().goals)
      if (goal.is_absent) absent.insert(goal.goal);
    return absent;
  };
  EXPECT_EQ(goals_with(false), std::set<std::string>{"stool"});
  EXPECT_EQ(goals_with(true), std::set<std::string>{});
}

}  // namespace
}  // namespace crossnav::evaluation
