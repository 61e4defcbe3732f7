// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visit_maker.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/micro_scene.h"

namespace crossnav::evaluation {
namespace {

/// A room with five objects that have a name of their own, and two of each of three categories.
std::unique_ptr<SceneContext> Room() {
  sim::test::MicroScene micro;
  micro.Room(0, 0, 12, 6);
  int place = 0;
  const auto add = [&](const char* name, const char* category) {
    const Vector3d p(1.0 + 2.0 * (place % 6), place < 6 ? 0.5 : 5.0, 0);
    micro.Begin(name, category);
    micro.Box(p, p + Vector3d(0.5, 0.5, 0.9));
    ++place;
  };
  for (const char* name : {"floor lamp", "desk", "stool", "bench", "refrigerator"}) add(name, "");
  for (const char* category : {"chair", "bed", "toilet", "chair", "bed", "toilet"})
    add(category, category);
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

}  // namespace
}  // namespace crossnav::evaluation
