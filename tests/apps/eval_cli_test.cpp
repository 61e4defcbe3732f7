// SPDX-License-Identifier: MIT
// Evaluations, reports and suites as a user runs them.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "apps/cli_fixture.h"
#include "support/places.h"

namespace crossnav {
namespace {

using EvalCli = test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;
using test::ReadText;
using test::WriteText;
namespace fs = std::filesystem;

TEST_F(EvalCli, EvalIsTheSameForAnyNumberOfJobsAndShards) {
  const std::string eval =
      std::string("eval --quiet --json --scenes scenes --episodes e.json") + kSmall;
  ASSERT_EQ(Run(eval + " --out a").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out b --jobs 3").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out c --shard 0/2").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out c --shard 1/2").exit_code, 0);
  const auto records = [&](const std::string& file) {
    std::istringstream stream(ReadText(At(file)));
    std::vector<Json> lines;
    for (std::string line; std::getline(stream, line);) {
      lines.push_back(Json::parse(line));
      lines.back().erase("wall_s");
      lines.back().erase("timing_ms");
    }
    std::sort(lines.begin() + 1, lines.end());  // written when finished
    return lines;
  };
  const auto a = records("a/results.jsonl");
  ASSERT_EQ(a.size(), 5u);
  EXPECT_EQ(a[0]["kind"], "header");
  EXPECT_EQ(a, records("b/results.jsonl"));
  auto c = records("c/results.0-of-2.jsonl");
  const auto rest = records("c/results.1-of-2.jsonl");
  c.insert(c.end(), rest.begin() + 1, rest.end());
  std::sort(c.begin() + 1, c.end());
  for (std::size_t i = 1; i < a.size(); ++i) EXPECT_EQ(a[i], c[i]);
  // Both shards make one report; one alone does not.
  EXPECT_EQ(Run("report a c --out report").exit_code, 0);
  EXPECT_TRUE(fs::exists(At("report/report.md")));
  EXPECT_EQ(Run("report c/results.0-of-2.jsonl --out other").exit_code, 1);
}

TEST_F(EvalCli, AnObjectNavFileIsJudgedAsTheFieldDoes) {
  Json file = Episodes();
  int number = 0;
  for (Json& episode : file["episodes"]) {
    episode["object_category"] = episode["goals"][0];
    episode["goals"] = Json::array();
    episode["episode_id"] = std::to_string(number++);
  }
  WriteText(At("objectnav.json"), file.dump());
  const Outcome outcome =
      Run("eval --quiet --json --scenes scenes --episodes objectnav.json --out run --config "
          "'" +
          test::SourcePath("config/objectnav.toml") + "'" + std::string(kSmall));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_EQ(document["episodes"], 4);
  EXPECT_EQ(document["goals"], 1);
  for (const char* name : {"SR", "SPL", "soft_SPL", "distance_to_goal_m"}) {
    EXPECT_TRUE(document["metrics"][name].contains("value")) << name;
  }
  std::istringstream results(ReadText(At("run/results.jsonl")));
  std::string header;
  std::getline(results, header);
  EXPECT_EQ(Json::parse(header)["config"]["eval"]["success"], "viewpoint");
}

TEST_F(EvalCli, AnEpisodeThatStartsOffTheNavmeshIsInvalidAndNoFigureCountsIt) {
  Json file = Episodes();
  file["episodes"][0]["start_position"] = {500, 0, 500};
  WriteText(At("e.json"), file.dump());
  const Outcome outcome =
      Run("eval --json --scenes scenes --episodes e.json --out run" + std::string(kSmall));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_EQ(document["episodes"], 3);
  EXPECT_EQ(document["invalid"], 1);
  EXPECT_EQ(document["failed"], Json::object());
  EXPECT_NE(outcome.err.find("failed (invalid)"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("the start is off the navmesh"), std::string::npos) << outcome.err;
  const Outcome text = Run("metrics run/results.jsonl");
  EXPECT_NE(text.out.find("invalid: 1 episodes"), std::string::npos) << text.out;
  EXPECT_EQ(Run("report run --out report").exit_code, 0);
}

TEST_F(EvalCli, AnInterruptedEvalResumesAndGivesTheSameFile) {
  const std::string eval =
      std::string("eval --quiet --scenes scenes --episodes e.json --out run") + kSmall;
  ASSERT_EQ(Run(eval).exit_code, 0);
  const std::string whole = ReadText(At("run/results.jsonl"));
  std::size_t second_line = whole.find('\n', whole.find('\n') + 1) + 1;
  WriteText(At("run/results.jsonl"), whole.substr(0, second_line + 50));  // torn
  ASSERT_EQ(Run(eval + " --resume").exit_code, 0);
  const std::string again = ReadText(At("run/results.jsonl"));
  EXPECT_EQ(again.substr(0, second_line), whole.substr(0, second_line));
  EXPECT_EQ(std::count(again.begin(), again.end(), '\n'), 5);
  const Outcome other = Run(eval + " --set eval.seed=99");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("another run"), std::string::npos) << other.err;
  EXPECT_EQ(ReadText(At("run/results.jsonl")), again);
}

TEST_F(EvalCli, AKilledEvalResumesToTheSameRecords) {
  const std::string eval =
      std::string("eval --quiet --scenes scenes --episodes e.json --jobs 2") + kSmall;
  ASSERT_EQ(Run(eval + " --out whole").exit_code, 0);
  const std::string killed =
      "cd '" + folder_.path().string() + "'; '" + test::ProgramPath() + "' " + eval +
      " --out killed & pid=$!; until [ \"$(cat killed/results.jsonl 2>/dev/null | wc -l)\" -ge 2 "
      "]; "
      "do kill -0 $pid || exit 1; sleep 0.02; done; kill -9 $pid; wait $pid 2>/dev/null; true";
  ASSERT_EQ(std::system(killed.c_str()), 0);
  EXPECT_LE(std::ranges::count(ReadText(At("killed/results.jsonl")), '\n'), 5);
  ASSERT_EQ(Run(eval + " --out killed").exit_code, 0);
  const Outcome a = Run("metrics whole/results.jsonl --json");
  const Outcome b = Run("metrics killed/results.jsonl --json");
  EXPECT_EQ(Json::parse(a.out)["episodes"], 4);
  EXPECT_EQ(a.out, b.out);
}

TEST_F(EvalCli, AnEpisodeOutOfTimeIsAFailedRecord) {
  const Outcome outcome =
      Run(std::string("eval --json --scenes scenes --episodes e.json --out run --jobs 2 "
                      "--keep-replays failures --set eval.episode_seconds=0.01") +
          kSmall);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["failed"]["time"], 4);
  EXPECT_EQ(Json::parse(outcome.out)["metrics"]["SR"]["value"], 0);
  EXPECT_NE(outcome.err.find("failed (time)"), std::string::npos) << outcome.err;
  EXPECT_EQ(Run("report run --out report").exit_code, 0);
  EXPECT_NE(ReadText(At("report/report.md")).find("### Failed episodes"), std::string::npos);
}

TEST_F(EvalCli, KeepReplaysKeepsReplaysOfFailedEpisodes) {
  const std::string eval =
      std::string("eval --quiet --json --scenes scenes --episodes e.json --keep-replays failures") +
      kSmall;
  ASSERT_EQ(Run(eval + " --out run --jobs 2").exit_code, 0);
  std::istringstream stream(ReadText(At("run/results.jsonl")));
  int kept = 0;
  for (std::string line; std::getline(stream, line);) {
    const Json record = Json::parse(line);
    if (record["kind"] != "episode") continue;
    bool is_complete = record["stages"].size() == record["goals"].size();
    for (const Json& stage : record["stages"]) is_complete = is_complete && stage["success"];
    const fs::path replay = At("run/replays/" + record["episode_id"].get<std::string>() + ".mcap");
    EXPECT_EQ(fs::exists(replay), !is_complete) << replay;
    if (is_complete) continue;
    ++kept;
    EXPECT_EQ(Run("replay export '" + replay.string() + "' --out page.html").exit_code, 0);
  }
  EXPECT_GT(kept, 0);  // 40 actions are not enough for three goals
  for (const auto& entry : fs::directory_iterator(At("run/replays"))) {
    EXPECT_EQ(entry.path().extension(), ".mcap") << entry.path();
  }
}

TEST_F(EvalCli, BadOutputPathsAreRefusedBeforeTheFirstStep) {
  WriteText(At("file"), "in the way");
  const std::string run =
      "run --scenes scenes --episodes e.json --quiet --episode " + FirstId() + kSmall;
  ExpectFailure(run + " --out file/x", {"file/x", "--out"});
  ExpectFailure(run + " --out ok --replay file/r.mcap", {"file/r.mcap", "--replay"});
  ExpectFailure(run + " --out ok --save-map scenes", {"scenes", "--save-map"});
  const std::string eval = "eval --quiet --scenes scenes --episodes e.json" + std::string(kSmall);
  ExpectFailure(eval + " --out file", {"file", "--out"});
  ExpectFailure("scene render scenes/00001-CrossnavHouse --out file/p.png", {"file/p.png"});
  ExpectFailure("world generate --count 50 --furniture none --out file", {"file", "--out"});
  ExpectFailure("world generate --furniture none --out houses --contact-sheet file/s.png",
                {"file/s.png", "--contact-sheet"});
  ExpectFailure("episodes generate --scenes scenes --out file/e.json", {"file/e.json"});
  EXPECT_FALSE(fs::exists(At("ok")));
  EXPECT_FALSE(fs::exists(At("houses")));
}

TEST_F(EvalCli, ReportComparesRunsAndRefusesAnotherTask) {
  const std::string eval =
      std::string("eval --quiet --scenes scenes --episodes e.json --jobs 2") + kSmall;
  ASSERT_EQ(Run(eval + " --out a").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out b --set policy.poi.use_history=false").exit_code, 0);
  const Outcome fair = Run("report a b --out report");
  EXPECT_EQ(fair.exit_code, 0) << fair.err;
  EXPECT_NE(fair.out.find("compared: policy.poi.use_history: true and false"), std::string::npos)
      << fair.out;
  EXPECT_NE(fair.out.find("episodes flipped"), std::string::npos);
  ASSERT_EQ(Run(eval + " --out c --set eval.success_radius_m=2").exit_code, 0);
  ExpectFailure("report a c --out other", {"eval.success_radius_m", "--force"});
  EXPECT_FALSE(fs::exists(At("other")));
  const Outcome forced = Run("report a c --out other --force --json");
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_EQ(Json::parse(forced.out)["comparisons"][0]["unfair"].size(), 1u);
  EXPECT_NE(ReadText(At("other/report.md")).find("**Forced"), std::string::npos);
}

/// A stand-in for the interpreter, so that no Python package is needed; python/tests has the real
/// one.
TEST_F(EvalCli, HtmlReportsAreMadeByThePythonPackage) {
  WriteText(At("r.mcap"), "a replay");
  WriteText(At("python's own"),
            "#!/bin/sh\nprintf '<%s>' \"$@\" >words\n"
            "case $* in *bad*) echo working; echo 'crossnav.rerun: bad: no'; exit 1;; "
            "*gone*) echo 'python: No module named crossnav'; exit 1;; esac\n");
  fs::permissions(At("python's own"), fs::perms::owner_all);
  const auto with = [&](const std::string& python, const std::string& arguments) {
    return RunIn(folder_, arguments, "CROSSNAV_PYTHON=\"" + python + "\"");
  };
  const std::string here = "$PWD/python's own";
  const Outcome done = with(here, "replay export r.mcap --to \"it's r.rrd\"");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "it's r.rrd\n");
  EXPECT_EQ(ReadText(At("words")), "<-m><crossnav.rerun><r.mcap><--to><it's r.rrd>");
  const Outcome bad = with(here, "replay export r.mcap --out bad.rrd");
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_TRUE(bad.err.ends_with("crossnav.rerun: bad: no\n")) << bad.err;
  for (const auto& [python, out] :
       {std::pair(here, "gone.rrd"), {std::string("no/python"), "r.rrd"}}) {
    const Outcome none = with(python, std::string("replay export r.mcap --out ") + out);
    EXPECT_EQ(none.exit_code, 1);
    EXPECT_NE(none.err.find("pip install \"crossnav[rerun]\""), std::string::npos) << none.err;
    EXPECT_NE(none.err.find("CROSSNAV_PYTHON"), std::string::npos) << none.err;
    EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;
  }
  const std::string eval = std::string("eval --quiet --scenes scenes --episodes e.json") + kSmall;
  ASSERT_EQ(Run(eval + " --out run").exit_code, 0);
  const Outcome page = with(here, "report run --out report --page");
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_TRUE(page.out.ends_with("report/report.html\n")) << page.out;
  EXPECT_EQ(ReadText(At("words")), "<-m><crossnav.report><run><--out><report/report.html>");
}

TEST_F(EvalCli, SuitesAreNamedAndAForeignManifestIsRefused) {
  ExpectFailure("suite make nowhere", {"nowhere", "crossnav-mfmon-1-mini"});
  WriteText(At("file"), "in the way");
  ExpectFailure("suite make crossnav-mfmon-1 --out file", {"file", "--out"});
  fs::create_directories(At("out/suites/crossnav-mfmon-1-mini"));
  WriteText(At("out/suites/crossnav-mfmon-1-mini/manifest.json"), R"({"format": 1, "suite": "x"})");
  ExpectFailure("suite run crossnav-mfmon-1-mini", {"manifest.json"});
}

TEST_F(EvalCli, EvalSaysWhyEachFailedStageFailedAndReportCountsThem) {
  const std::string eval =
      std::string("eval --json --scenes scenes --episodes e.json --jobs 2 --out run") + kSmall;
  const Outcome outcome = Run(eval);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream stream(ReadText(At("run/results.jsonl")));
  int failed = 0, lines = 0;
  for (std::string line; std::getline(stream, line);) {
    for (const Json& stage : Json::parse(line).value("stages", Json::array())) {
      EXPECT_EQ(stage["extra"].contains("cause"), !stage["success"].get<bool>());
      failed += stage["success"] ? 0 : 1;
    }
  }
  std::istringstream err(outcome.err);
  for (std::string line; std::getline(err, line);) {
    lines += line.find("of the walkable area seen | steps: ") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(failed, 0);
  EXPECT_EQ(lines, failed) << outcome.err;
  ASSERT_EQ(Run("report run --out report").exit_code, 0);
  EXPECT_NE(ReadText(At("report/report.md")).find("### Causes of failure"), std::string::npos);
  EXPECT_GT(fs::file_size(At("report/causes.csv")), 30u);
}

}  // namespace
}  // namespace crossnav
