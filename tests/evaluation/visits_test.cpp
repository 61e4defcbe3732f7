// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visits.h"

#include <gtest/gtest.h>

#include "crossnav/evaluation/lifelong/visit_report.h"
#include "crossnav/evaluation/lifelong/visit_runner.h"

namespace crossnav::evaluation {
namespace {

HouseVisit SomeVisit(int day) {
  HouseVisit visit;
  visit.house = "00301-House301";
  visit.day = day;
  visit.scene_id = "00301-House301-day1";
  visit.start.p_world = {1.25, -2.5, 3};
  visit.start.yaw_rad = 0.5;
  visit.goals = {{"floor \"lamp\"", "other_floor", false, {0, 1}, {{1, 2, 0}, {3, 4.5, 0}}},
                 {"tv_monitor", "removed", true, {}, {{1, 1, 1}}},
                 {"bed", "static", false, {1}, {}}};
  return visit;
}

GoalRecord Goal(const std::string& track, bool success, double shortest_m, double length_m) {
  GoalRecord goal;
  goal.goal = "chair";
  goal.track = track;
  goal.outcome = success ? Outcome::kSuccess : Outcome::kOutOfTime;
  goal.success = success;
  goal.shortest_m = shortest_m;
  goal.length_m = length_m;
  goal.actions = 300;
  goal.budget = 1200;
  return goal;
}

VisitResults RunOf(const std::string& mode, double length_m) {
  VisitResults results;
  results.run = {"abc", mode, "full", "def", "oracle-perception", "1"};
  for (int house = 0; house < 6; ++house) {
    VisitRecord record;
    record.house = "house" + std::to_string(house);
    record.day = 1;
    record.goals = {Goal("other_room", true, 4, length_m + house)};
    results.records.push_back(record);
  }
  return results;
}

TEST(Visits, AreReadAsTheyWereWritten) {
  const std::string text = VisitsText({SomeVisit(0), SomeVisit(2)});
  const auto file = ParseVisits(text, "visits.json");
  ASSERT_TRUE(file.has_value()) << file.error().Message();
  ASSERT_EQ(file->visits.size(), 2U);
  EXPECT_EQ(file->visits[1].goals, SomeVisit(2).goals);
  EXPECT_EQ(VisitsText(file->visits), text);
}

TEST(Visits, OfANetworkHaveCategoriesAlone) {
  std::vector<HouseVisit> visits = {SomeVisit(0)};
  EXPECT_EQ(LeaveOutNames(&visits), 1) << "the floor lamp";
  const std::vector<VisitGoal> all = SomeVisit(0).goals;
  EXPECT_EQ(visits[0].goals, std::vector<VisitGoal>(all.begin() + 1, all.end()));
}

TEST(Visits, TruncatedFilesAndDaysOutOfOrderAreErrors) {
  const std::string text = VisitsText({SomeVisit(1)});
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    ASSERT_FALSE(ParseVisits(text.substr(0, size), "visits.json").has_value()) << size;
  }
  const auto again = ParseVisits(VisitsText({SomeVisit(1), SomeVisit(1)}), "visits.json");
  ASSERT_FALSE(again.has_value());
  EXPECT_NE(again.error().Message().find("visits[1]"), std::string::npos);
}

TEST(Visits, AGoalOfAnUnknownTrackIsAnErrorThatNamesIt) {
  std::string text = VisitsText({SomeVisit(1)});
  text.replace(text.find("\"static\""), 8, "\"frozen\"");
  const auto file = ParseVisits(text, "visits.json");
  ASSERT_FALSE(file.has_value());
  EXPECT_NE(file.error().Message().find("goals[2]"), std::string::npos);
}

TEST(Visits, ResultsAreReadAsTheyWereWritten) {
  VisitResults results = RunOf("keep", 8);
  results.records[2].failure = "crash: \"so\"";
  const std::string text = VisitResultsText(results);
  const auto read = ParseVisitResults(text, "visits.jsonl");
  ASSERT_TRUE(read.has_value()) << read.error().Message();
  EXPECT_EQ(read->run, results.run);
  EXPECT_EQ(VisitResultsText(*read), text);
  EXPECT_FALSE(ParseVisitResults(text.substr(0, text.size() - 20), "visits.jsonl").has_value());
}

/// Regression: two houses that a full disk had stopped counted as played, for ever.
TEST(Visits, HousesThatFailedArePlayedAgain) {
  VisitResults results;
  for (const char* house : {"a", "b"})
    for (int day = 0; day < 3; ++day) {
      VisitRecord& record = results.records.emplace_back();
      record.house = house;
      record.day = day;
    }
  EXPECT_EQ(DropFailedHouses(&results), 0);
  results.records.back().failure = "b.map: the disk is full";
  EXPECT_EQ(DropFailedHouses(&results), 1);
  ASSERT_EQ(results.records.size(), 3U);
  for (const VisitRecord& record : results.records) EXPECT_EQ(record.house, "a");
}

TEST(StaleWatch, CountsHowOftenTheAgentSetsOutForAPlaceThatIsStale) {
  StaleWatch watch({{2, 0, 0}, {8, 0, 0}});
  const auto step_to = [&](const char* kind, double x) {
    trace::StepTrace step;
    trace::CandidateTrace candidate;
    candidate.kind = kind;
    candidate.is_target = true;
    candidate.p_focus_world = {x, 0.3, 0.5};
    step.candidates = {candidate};
    watch.Add(step);
  };
  step_to("history_poi", 2);
  step_to("history_poi", 2.2);
  step_to("traversable_frontier", 2);
  step_to("history_poi", 8);
  step_to("history_poi", 5);
  EXPECT_EQ(watch.visits(), 2);
  EXPECT_EQ(watch.revised_after(), 4);
}

TEST(VisitReport, AShorterWayInEveryHouseIsADifferenceAboveZero) {
  const auto comparison = CompareVisits(RunOf("none", 16), RunOf("keep", 8));
  ASSERT_TRUE(comparison.has_value());
  ASSERT_EQ(comparison->tracks.size(), 1U);
  const auto& [track, difference] = comparison->tracks.front();
  EXPECT_EQ(track, "other_room");
  EXPECT_EQ(difference.houses, 6);
  ASSERT_TRUE(difference.spl.has_value());
  EXPECT_GT(difference.spl->interval.low, 0);
  EXPECT_DOUBLE_EQ(difference.success.value, 0);
}

TEST(VisitReport, ShorterVisitsAreTheFirstGoalsOfEach) {
  VisitResults results = RunOf("keep", 8);
  results.records[0].goals.assign(3, Goal("static", true, 4, 8));
  results.records[0].goals[2] = Goal("static", false, 4, 8);
  KeepFirstGoals(2, &results);
  EXPECT_EQ(results.records[1].goals.size(), 1U);
  const auto figures = FiguresOf(results);
  ASSERT_EQ(figures[0].first, "static");
  EXPECT_EQ(figures[0].second.goals, 2);
  EXPECT_DOUBLE_EQ(figures[0].second.success.value, 1);
}

TEST(VisitReport, RunsOfOtherVisitsAreNotCompared) {
  VisitResults other = RunOf("none", 8);
  other.run.suite_hash = "else";
  EXPECT_FALSE(CompareVisits(RunOf("keep", 8), other).has_value());
  EXPECT_FALSE(CompareVisits(RunOf("keep", 8), other, {}, true).has_value());
}

/// Regression: `suite report --force` did not compare lifelong runs of other settings.
TEST(VisitReport, RunsOfOtherSettingsAreComparedByForceAndTheReportSaysSo) {
  VisitResults other = RunOf("keep", 8);
  other.run.config_hash = "else";
  const VisitResults none = RunOf("none", 16);
  EXPECT_FALSE(CompareVisits(none, other).has_value());
  const auto comparison = CompareVisits(none, other, {}, true);
  ASSERT_TRUE(comparison.has_value());
  const std::string text = VisitReportMarkdown("suite", {none, other}, {*comparison});
  EXPECT_NE(text.find("in pairs (settings differ)"), std::string::npos) << text;
}

TEST(VisitReport, AnAbsentGoalHasSuccessAndNoSpl) {
  VisitResults results = RunOf("keep", 8);
  for (auto& record : results.records) {
    record.goals = {Goal("removed", true, 0, 12)};
    record.goals[0].is_absent = true;
  }
  const auto figures = FiguresOf(results);
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_DOUBLE_EQ(figures[0].second.success.value, 1);
  EXPECT_FALSE(figures[0].second.spl.has_value());
  EXPECT_DOUBLE_EQ(figures[0].second.unspent.value, 0.75);
}

}  // namespace
}  // namespace crossnav::evaluation
