// SPDX-License-Identifier: MIT
// "Cut off" is not "explored": the agent's last resorts before it declares that nothing is left,
// and the views that decide about a hint. On ground set by hand.
#include "crossnav/agent/last_resort.h"

#include <algorithm>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "agent/two_rooms.h"
#include "crossnav/agent/cut_off.h"
#include "crossnav/agent/exploration_prices.h"
#include "crossnav/agent/hints.h"
#include "crossnav/agent/object_search.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/settle.h"
#include "support/map_of_states.h"
#include "support/sightings.h"

namespace crossnav::agent {
namespace {

using geometry::VoxelKey;
using geometry::VoxelState;
using test::AddGround;
using test::BoxWalker;
using test::FakeSight;
using test::FakeSuite;
using test::SetState;
using testing::BoxOf;
using testing::SmallConfig;
using testing::Tells;
using testing::Walk;

/// Two floors of 2 x 2 m that a gap of one column joins, between walls; the agent is on the first.
struct TwoFloors {
  const Config config;
  World world{config};
  GoalState goal;
  const Observation obs;
  const std::vector<policy::Sighting> sightings;
  StepState now{config, world, goal, {}, {}, obs, sightings};

  TwoFloors() {
    AddGround(world.map, 0, 0, 20, 20, 0);
    AddGround(world.map, 22, 0, 42, 20, 0);
    AddGround(world.map, 20, 10, 22, 11, 0);
    for (const int x : {20, 21})
      for (int y = 0; y < 20; ++y)
        for (int z = 1; z <= 15 && y != 10; ++z)
          SetState(world.map, {x, y, z}, VoxelState::kOccupied);
    world.ground.Rebuild(world.map);
    world.has_level = true;
    world.level_m = 0.1;
    world.levels_m = {0.1};
    now.agent.p_world = now.eye.p_world = Vector3d(1, 1, 0.1);
    goal.p_looked_around_world = now.agent.p_world;
  }
  bool Reaches(const VoxelKey& key) {
    planner::GroundSearch search(world.ground, config.planner,
                                 *world.ground.StandingAt(now.agent.p_world), RulesOf(now));
    while (const auto place = search.Next())
      if (*place == key) return true;
    return false;
  }
};

TEST(CutOff, GroundBehindANarrowGapIsNamedAndTheGapIsTried) {
  TwoFloors given;
  EXPECT_FALSE(given.Reaches({30, 10, 1}));
  const CutOff cut_off = FindCutOff(given.now);
  EXPECT_NEAR(cut_off.ground_m2, 4.0, 0.1);
  EXPECT_EQ(cut_off.levels, 0);
  EXPECT_EQ(Describe(cut_off).substr(0, 1), "4");
  ASSERT_TRUE(TryLastResort(given.now));
  ASSERT_EQ(given.goal.events.size(), 1U);
  EXPECT_NE(given.goal.events[0].find("narrow gaps are tried"), std::string::npos)
      << given.goal.events[0];
  EXPECT_TRUE(given.Reaches({30, 10, 1}));
  EXPECT_TRUE(FindCutOff(given.now).IsEmpty());
}

/// Regression: a washing machine that six frames had shown, behind a narrow gap, was said to be
/// gone.
TEST(CutOff, WhatIsInSightBehindANarrowGapIsNotGone) {
  TwoFloors given;
  given.world.revision.emplace();
  given.goal.full.search.emplace().unseen = 0;  // everywhere else was looked at
  EXPECT_TRUE(IsSearchOver(given.now));
  for (const int step : {1, 2})
    given.goal.live.Update({test::SightingOfWall({30, 10, 1})}, given.config.policy.object,
                           given.config.map.voxel_m, step);
  EXPECT_FALSE(IsSearchOver(given.now));
  ASSERT_TRUE(TryLastResort(given.now));
  EXPECT_NE(given.goal.events.back().find("narrow gaps are tried"), std::string::npos)
      << given.goal.events.back();
  EXPECT_TRUE(given.Reaches({28, 10, 1}));
}

TEST(CutOff, WhatManyFramesShowedWeaklyIsNotGone) {
  TwoFloors given;
  given.world.revision.emplace();
  given.goal.full.search.emplace().unseen = 0;  // everywhere was looked at
  policy::ObjectConfig weak = given.config.policy.object;
  weak.detector_confidence = given.config.policy.explore.hint_confidence;
  policy::Sighting lamp = test::SightingOfWall({10, 10, 1});
  lamp.confidence = 0.65;
  const auto see = [&](int from, int to) {
    for (int step = from; step < to; ++step)
      given.goal.full.hints.Update({lamp}, weak, given.config.map.voxel_m, step);
  };
  see(0, 9);
  EXPECT_FALSE(TryLastResort(given.now));
  EXPECT_NE(given.goal.events.back().find("it is gone"), std::string::npos);
  see(9, 10);
  ASSERT_TRUE(TryLastResort(given.now));
  EXPECT_NE(given.goal.events.back().find("back to what 10 frames showed"), std::string::npos)
      << given.goal.events.back();
  ASSERT_EQ(given.goal.live.Stable(given.config.policy.object).size(), 1U);
  while (TryLastResort(given.now)) {
  }
  EXPECT_EQ(given.goal.full.claims.settled_for.size(), 1U) << "once";
}

/// Regression: a bowl that 77 frames had shown was said to be gone, because one of them, with the
/// confidence of a POI, counted as a judgement.
TEST(CutOff, OneConfidentFrameAmongManyWeakOnesIsNoJudgement) {
  TwoFloors given;
  given.world.revision.emplace();
  given.goal.full.search.emplace().unseen = 0;
  const policy::ObjectConfig& object = given.config.policy.object;
  policy::ObjectConfig weak = object;
  weak.detector_confidence = given.config.policy.explore.hint_confidence;
  policy::Sighting bowl = test::SightingOfWall({10, 10, 1});
  for (int step = 0; step < 12; ++step) {
    bowl.confidence = step == 5 ? object.detector_confidence + 0.01 : 0.65;
    given.goal.live.Update({bowl}, object, given.config.map.voxel_m, step);
    given.goal.full.hints.Update({bowl}, weak, given.config.map.voxel_m, step);
  }
  ASSERT_TRUE(given.goal.live.Stable(object).empty());
  ASSERT_TRUE(TryLastResort(given.now));
  EXPECT_NE(given.goal.events.back().find("back to what 12 frames showed"), std::string::npos)
      << given.goal.events.back();
}

/// Regression: an agent went away from a bowl on record that each frame of a visit showed weakly.
TEST(CutOff, WeakFramesAreEnoughAtABelievedRecord) {
  TwoFloors given;
  policy::ObjectConfig weak = given.config.policy.object;
  weak.detector_confidence = given.config.policy.explore.hint_confidence;
  policy::Sighting bowl = test::SightingOfWall({10, 10, 1});
  bowl.confidence = 0.65;
  const auto see = [&](int from, int to) {
    for (int step = from; step < to; ++step)
      given.goal.full.hints.Update({bowl}, weak, given.config.map.voxel_m, step);
  };
  HistoryPoi place, other;
  place.voxels = bowl.voxels;
  other.voxels = test::SightingOfWall({2, 2, 1}).voxels;
  given.goal.goal = "bowl";
  objects::ObjectRecord record;
  record.category = "bowl";
  record.views = 5;
  record.confidence = 0.9;
  std::vector<objects::ObjectRecord> records;
  for (const HistoryPoi* poi : {&place, &other}) {
    record.voxels = poi->voxels;
    objects::Measure(record, given.config.map.voxel_m);
    records.push_back(record);
  }
  see(0, 10);
  given.world.revision.emplace();
  EXPECT_FALSE(SettleForSightAt(given.now, place)) << "nothing on record";
  given.world.objects.Load(records);
  EXPECT_FALSE(SettleForSightAt(given.now, other)) << "nothing seen there";
  given.world.revision.reset();
  EXPECT_FALSE(SettleForSightAt(given.now, place)) << "memory.mode = keep";
  given.world.revision.emplace();
  ASSERT_TRUE(SettleForSightAt(given.now, place));
  ASSERT_EQ(given.goal.live.Stable(given.config.policy.object).size(), 1U);
  EXPECT_FALSE(SettleForSightAt(given.now, place)) << "once";
}

TEST(CutOff, AnUnreachableLevelIsNamedInTheDeclaration) {
  TwoFloors given;
  AddGround(given.world.map, 0, 0, 10, 10, 28);
  given.world.ground.Rebuild(given.world.map);
  given.world.levels_m.push_back(2.9);
  int resorts = 0;
  while (TryLastResort(given.now)) ++resorts;
  EXPECT_LE(resorts, 6);
  const std::string& declared = given.goal.events.back();
  EXPECT_EQ(declared.find("all explored; cut off: 1 level"), 0U) << declared;
}

TEST(CutOff, WhereNothingIsCutOffNoRuleIsRelaxed) {
  TwoFloors given;
  AddGround(given.world.map, 20, 5, 22, 15, 0);
  given.world.ground.Rebuild(given.world.map);
  while (TryLastResort(given.now)) {
  }
  EXPECT_FALSE(given.goal.full.may_squeeze);
  EXPECT_FALSE(given.goal.full.may_step_on_seats);
  EXPECT_EQ(given.goal.events.back(), "all explored; cut off: nothing");
}

// Regression: on steep flights (bench stairs, high risers, seeds 21 and 39) the navmesh's foot was
// between two treads of the map; the agent declared all explored on the flight.
TEST(CutOff, AStrandedAgentTriesAStepInEveryHeading) {
  TwoFloors given;
  AddGround(given.world.map, 60, 0, 63, 8, 8);
  given.world.ground.Rebuild(given.world.map);
  given.now.agent.p_world = given.now.eye.p_world = Vector3d(6.15, 0.4, 0.9);
  given.goal.p_looked_around_world = given.now.agent.p_world;
  bool has_stepped = false;
  while (!has_stepped && TryLastResort(given.now))
    has_stepped = given.goal.events.back().find("stranded") == 0;
  ASSERT_TRUE(has_stepped);
  const Scan* scan = std::get_if<Scan>(&given.goal.full.activity);
  ASSERT_NE(scan, nullptr);
  EXPECT_EQ(std::count(scan->turns.begin(), scan->turns.end(), Action::kMoveForward), 12);
}

// Remembered places upstairs counted as visited from the storey below.
TEST(Visits, HappenOnTheStoreyOfTheObject) {
  TwoFloors given;
  const std::vector<VoxelKey> upstairs = {{10, 12, 24}};
  const auto start = *given.world.ground.StandingAt(given.now.agent.p_world);
  ViewWish wish{upstairs, 2.6, {}, {}, Vector3d(1.05, 1.25, 2.45)};
  EXPECT_TRUE(NearestView(given.now, start, wish));
  wish.is_on_storey = true;
  EXPECT_FALSE(NearestView(given.now, start, wish));
  AddGround(given.world.map, 5, 5, 12, 12, 20);
  given.world.ground.Rebuild(given.world.map);
  EXPECT_FALSE(NearestView(given.now, start, wish)) << "no way leads there";
}

policy::Sighting SightingAt(const VoxelKey& key, double confidence) {
  policy::Sighting sighting;
  sighting.voxels = {key};
  sighting.p_center_world = geometry::CenterOf(key, 0.1);
  sighting.confidence = confidence;
  sighting.area_fraction = 0.05;
  return sighting;
}

// A hint was spent at the approach range although a nearer view would have decided.
TEST(Hints, AreLookedAtFromNearerWhileTheConfidenceRises) {
  TwoFloors given;
  policy::ObjectConfig any;
  any.detector_confidence = 0.1;
  any.min_box_area_fraction = 0;
  const auto see = [&](double confidence, int step) {
    given.goal.full.hints.Update({SightingAt({16, 10, 8}, confidence)}, any, 0.1, step);
  };
  see(0.60, 0);
  const int id = given.goal.full.hints.all().front().id;
  given.now.agent.p_world = Vector3d(0.55, 1.05, 0.1);
  EXPECT_FALSE(NoteLook(given.now, id));
  const auto views = [&] {
    double nearest_m = 1e9;
    const Situation situation = given.now;
    Hints hints(situation);
    for (int x = 0; x < 20; ++x)
      for (const Hints::View& view : hints.SeenFrom({x, 10, 1}))
        if (view.is_nearer)
          nearest_m = std::abs(1.65 - geometry::CenterOf(view.candidate.standing[0], 0.1).x());
    return nearest_m;
  };
  EXPECT_LT(views(), 0.75) << "the last view was from 1.1 m";
  see(0.66, 1);
  given.now.agent.p_world = Vector3d(1.0, 1.05, 0.1);
  EXPECT_FALSE(NoteLook(given.now, id));
  EXPECT_LT(views(), 0.45);
  const int sides = given.config.policy.approach.max_viewpoints;
  for (int i = 1; i < sides; ++i) EXPECT_FALSE(NoteLook(given.now, id)) << i;
  EXPECT_TRUE(NoteLook(given.now, id)) << "no view raises it any more";
}

// The agent walked along the edge of a garden, one frontier after the other.
TEST(Doubt, AFrontierBesideFrontiersThatDidNotOpenCostsMore) {
  TwoFloors given;
  const policy::Relevancy relevancy;
  const auto price = [&](double x_m) {
    ExplorationCandidate found;
    found.place = {5, 5, 1};
    found.is_on_level = true;
    found.candidate.kind = policy::CandidateKind::kTraversableFrontier;
    found.candidate.p_focus_world = Vector3d(x_m, 0, 0.1);
    found.candidate.size = 10;
    const Situation situation = given.now;
    ExplorationPrices prices(situation, relevancy);
    return prices.Of(found, {{5, 5, 1}, {6, 5, 1}}, 1.0).target.score_m;
  };
  const double before_m = price(3), far_m = price(30);
  Attempt attempt;
  attempt.ending = Ending::kNotOpened;
  attempt.p_focus_world = Vector3d(2, 0, 0.1);
  given.goal.full.attempts = {attempt, attempt};
  EXPECT_DOUBLE_EQ(price(3), before_m + 2 * given.config.policy.explore.doubt_m);
  EXPECT_DOUBLE_EQ(price(30), far_m);
}

// Two live POIs took turns for a thousand steps: each turn forgot the views that had failed.
TEST(LiveViews, AreKeptWhileAnotherPoiIsApproached) {
  TwoFloors given;
  given.goal.active_live = 1;
  given.goal.tried_viewpoints = {Vector3d(1, 1, 0)};
  given.goal.failed_views = 2;
  given.goal.full.failed.push_back({2, {Vector3d(3, 3, 0), Vector3d(4, 4, 0)}, 3, 0.9});
  EXPECT_EQ(FailedViewsOf(given.goal, 1).count, 2);
  EXPECT_EQ(FailedViewsOf(given.goal, 2).p_from_world.size(), 2U);
  EXPECT_EQ(FailedViewsOf(given.goal, 3).count, 0);
}

/// Regression: ten frames had shown a television beyond a slit that the agent had bumped into; it
/// searched the other floors until the end.
TEST(LastResort, AWayToASteadySightIsOpenedBeforeTheRestIsExplored) {
  const Box3 couch = BoxOf(6.6, 0.4, 0, 7.5, 1.2, 0.8);
  BoxWalker walker = testing::TwoRooms();
  walker.rooms.shell = BoxOf(0, 0, 0, 8, 12, 2.6);  // much is left to explore on this side
  walker.rooms.solids = {BoxOf(4, 0, 0, 4.12, 0.4, 2.6), BoxOf(4, 1.4, 0, 4.12, 12, 2.6), couch};
  walker.pose = {Vector3d(0.8, 0.9, 0), 0, 0};
  FakeSight sight = testing::CouchSight(couch);
  sight.detect = [seen = sight.detect](const Observation& obs, std::string_view name) {
    auto found = seen(obs, name);
    for (auto& detection : found) detection.confidence = 0.65F;
    return found;
  };
  Agent agent(SmallConfig(), FakeSuite(sight));
  ASSERT_TRUE(agent.SetGoal("couch").has_value());
  Walk walk;
  int bumps = 0;
  for (int i = 0; i < 150 && !Tells(walk, "no way led to what many frames showed"); ++i) {
    const auto result = agent.Step(walker.Look());
    ASSERT_TRUE(result.has_value());
    walk.traces.push_back(ToJson(result->trace));
    const bool is_at_door = walker.pose.p_world.x() > 3.2;
    if (is_at_door && result->action == Action::kMoveForward && bumps < 8) {
      ++bumps;
      continue;
    }
    walker.Do(result->action);
  }
  EXPECT_TRUE(Tells(walk, "bumps forgotten")) << bumps;
  EXPECT_TRUE(Tells(walk, "no way led to what many frames showed"));
  EXPECT_FALSE(Tells(walk, "looking around"));
}

}  // namespace
}  // namespace crossnav::agent
