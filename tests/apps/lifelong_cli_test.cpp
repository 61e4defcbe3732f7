// SPDX-License-Identifier: MIT
// A memory that comes back on later days: the demo, and days of change.
#include <gtest/gtest.h>

#include <cstdlib>

#include "apps/cli_fixture.h"
#include "crossnav/trace/replay_reader.h"

namespace crossnav {
namespace {

using test::Cli;
using test::Json;
using test::Outcome;

constexpr const char* kSmallDays =
    " --set sensor.width_px=160 --set sensor.height_px=160 --set ground_truth.min_visible_px=20"
    " --set ground_truth.feature_dim=64";

using LifelongCli = Cli;

std::vector<std::string> LinesOf(const test::fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST_F(LifelongCli, TheDemoFindsUpstairsWhatTheNightCarriedThere) {
  const Outcome demo = Run("demo lifelong --quiet --json --out demo" + std::string(kSmallDays));
  ASSERT_EQ(demo.exit_code, 0) << demo.err;
  const Json stage = Json::parse(demo.out)["record"]["stages"][0];
  EXPECT_EQ(stage["outcome"], "success");
  EXPECT_EQ(stage["floor_start"], 0);
  EXPECT_EQ(stage["floor_end"], 1);
  for (const char* name : {"day1/replay.html", "day2/replay.html", "day2/floor_1.png", "home.map"})
    EXPECT_TRUE(test::fs::exists(At("demo/lifelong") / name)) << name;
  const auto day2 = trace::ReadReplay(At("demo/lifelong/day2/replay.mcap"));
  ASSERT_TRUE(day2.has_value()) << day2.error().Message();
  EXPECT_GT(day2->steps.front().trace.voxel_changes.size(), 50'000U) << "it shows the memory";
  const Json info = Json::parse(Run("map info demo/lifelong/home.map --json").out);
  EXPECT_EQ(info["revision"], 2);
}

TEST_F(LifelongCli, AMemoryKeptThroughDaysOfChangeStaysBoundedAndSurvivesKilledSaves) {
  const std::string command =
      "bench days --house scenes/00001-CrossnavHouse --days 3 --goals 2 --quiet --map days.map";
  const Outcome outcome =
      Run(command + " --json --set eval.action_budget=150" + std::string(kSmallDays));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json days = Json::parse(outcome.out)["days"];
  ASSERT_EQ(days.size(), 4U);
  for (const Json& day : days) {
    EXPECT_EQ(day["goals"], 2);
    EXPECT_GT(day["map_mb"], 0);
    EXPECT_GT(day["resident_mb"], 0);
    if (day["day"] == 0) continue;
    EXPECT_GT(day["changes"], 0);
    EXPECT_GT(day["load_s"], 0);
    const auto left = day["killed_save_leaves"].get<std::string>();
    EXPECT_TRUE(left == "old day" || left == "new day") << left;
  }
  const Json info = Json::parse(Run("map info days.map --json").out);
  EXPECT_EQ(info["revision"], 4);
  EXPECT_EQ(Run(command).exit_code, 1) << "days begin with nothing";
}

TEST_F(LifelongCli, AllModesShareTheFirstDay) {
  const test::fs::path suite = At("suites/crossnav-lifelong-1-mini");
  test::fs::create_directories(suite);
  test::fs::rename(At("scenes"), suite / "scenes");
  Json visits = Json::array();
  for (int day = 0; day < 2; ++day) {
    visits.push_back(
        {{"house", "00001-CrossnavHouse"},
         {"day", day},
         {"scene", "00001-CrossnavHouse"},
         {"start", {5.3613, 7.3312, 0.05}},
         {"yaw_rad", 0.0},
         {"goals",
          {{{"goal", "tv_monitor"}, {"track", day == 0 ? "first" : "static"}, {"floors", {0}}}}}});
  }
  test::WriteText(suite / "visits.json", Json({{"format", 1}, {"visits", visits}}).dump());
  const auto play = [&](const std::string& variant, const std::string& settings) {
    const Outcome run = Run("suite run crossnav-lifelong-1-mini --out suites --quiet --variant " +
                            variant + kSmallDays + settings);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return LinesOf(suite / "runs" / variant / "visits.jsonl");
  };
  const auto kept = play("keep", "");
  const auto first_map = suite / "runs/first_day/00001-CrossnavHouse.map";
  const auto made = test::fs::last_write_time(first_map);
  const auto revised = play("revise", ""), none = play("none", "");
  ASSERT_EQ(kept.size(), 3U) << "the run and two days";
  EXPECT_EQ(test::fs::last_write_time(first_map), made) << "played once";
  EXPECT_EQ(revised.at(1), kept.at(1));
  EXPECT_EQ(none.at(1), kept.at(1));
  EXPECT_NE(none.at(2), kept.at(2)) << "a memory knows the way";
  for (const char* mode : {"keep", "revise"}) {
    const auto map = "suites/crossnav-lifelong-1-mini/runs/" + std::string(mode) +
                     "/memory/00001-CrossnavHouse.map";
    EXPECT_EQ(Json::parse(Run("map info " + map + " --json").out)["revision"], 2) << mode;
  }
  const std::string report = "suite report crossnav-lifelong-1-mini --out suites --quiet";
  ASSERT_EQ(Run(report).exit_code, 0);
  const auto whole = LinesOf(suite / "report/report.md");
  ASSERT_EQ(Run(report + " --first-goals 1").exit_code, 0);
  EXPECT_EQ(LinesOf(suite / "report/report.md"), whole) << "a part has files of its own";
  EXPECT_NE(LinesOf(suite / "report/report-first-1.md").at(0).find("first 1 goals"),
            std::string::npos);
  test::fs::remove(suite / "runs/keep/visits.jsonl");
  const auto other = play("keep", " --set eval.action_budget=900");
  EXPECT_NE(test::fs::last_write_time(first_map), made) << "other settings are another first day";
  EXPECT_EQ(Json::parse(other.at(1))["goals"][0]["budget"], 900);
  EXPECT_EQ(Json::parse(Run("map info suites/crossnav-lifelong-1-mini/runs/first_day/"
                            "00001-CrossnavHouse.map --json")
                            .out)["revision"],
            1);
}

TEST_F(LifelongCli, ReplaysOfVisitsAreKeptWhereAGoalIsNotFound) {
  const test::fs::path suite = At("suites/crossnav-lifelong-1-mini");
  test::fs::create_directories(suite);
  test::fs::rename(At("scenes"), suite / "scenes");
  const Json goals = {{{"goal", "tv_monitor"}, {"track", "first"}, {"floors", {0}}}};
  const Json visit = {
      {"house", "00001-CrossnavHouse"},  {"day", 0},       {"scene", "00001-CrossnavHouse"},
      {"start", {5.3613, 7.3312, 0.05}}, {"yaw_rad", 0.0}, {"goals", goals}};
  test::WriteText(suite / "visits.json", Json({{"format", 1}, {"visits", {visit}}}).dump());
  const test::fs::path replay = suite / "runs/first_day/replays/00001-CrossnavHouse-day0.mcap";
  const std::string command =
      "suite run crossnav-lifelong-1-mini --out suites --quiet --keep-replays failures" +
      std::string(kSmallDays);
  ASSERT_EQ(Run(command + " --set eval.action_budget=3").exit_code, 0);
  const auto lost = trace::ReadReplay(replay);
  ASSERT_TRUE(lost.has_value()) << lost.error().Message();
  EXPECT_EQ(lost->steps.size(), 3U);
  ASSERT_EQ(lost->stages.size(), 1U);
  EXPECT_FALSE(lost->stages.front().success);
  test::fs::remove_all(suite / "runs");
  ASSERT_EQ(Run(command).exit_code, 0);
  EXPECT_FALSE(test::fs::exists(replay)) << "found";
}

TEST_F(LifelongCli, DrawnHomesNeedTheirArchive) {
  const Outcome outcome =
      Run("suite make crossnav-lifelong-1-drawn --homes no.jar --out suites --quiet");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("no.jar: no such file; install the package sweethome3d"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(test::fs::exists(At("suites/crossnav-lifelong-1-drawn/visits.json")));
}

TEST_F(LifelongCli, ImportedBuildingsNeedTheirFolder) {
  const Outcome unnamed = Run("suite make crossnav-lifelong-1-bim --out suites --quiet");
  EXPECT_EQ(unnamed.exit_code, 1);
  EXPECT_NE(unnamed.err.find("name the folder of their scenes with --buildings"), std::string::npos)
      << unnamed.err;
  test::fs::create_directories(At("empty"));
  for (const char* folder : {"nowhere", "empty"}) {
    const Outcome outcome = Run("suite make crossnav-lifelong-1-bim --out suites --quiet " +
                                std::string("--buildings ") + folder);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.err.find(folder), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(test::fs::exists(At("suites/crossnav-lifelong-1-bim/visits.json")));
}

// Each building three times, with other nights each time.
TEST_F(LifelongCli, ImportedBuildingsHaveDays) {
  if (std::getenv("CROSSNAV_LONG_TESTS") == nullptr) GTEST_SKIP() << "make test-long";
  const Outcome made =
      Run("suite make crossnav-lifelong-1-bim --out suites --quiet --jobs 2 "
          "--buildings scenes");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto visits =
      Json::parse(std::ifstream(At("suites/crossnav-lifelong-1-bim/visits.json")))["visits"];
  ASSERT_EQ(visits.size(), 12U);
  EXPECT_EQ(visits[4]["house"], "00002-CrossnavHouse");
  EXPECT_EQ(visits[5]["scene"], "00002-CrossnavHouse-day1");
  EXPECT_NE(visits[5]["goals"], visits[1]["goals"]);
}

}  // namespace
}  // namespace crossnav
