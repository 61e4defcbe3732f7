// SPDX-License-Identifier: MIT
// Imperfect sensors on the command line.
#include <gtest/gtest.h>

#include "apps/cli_fixture.h"

namespace crossnav {
namespace {

using NoiseCli = test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;
using test::ReadText;

TEST_F(NoiseCli, TheSweepWritesItsPrintedRowForEachValue) {
  const Outcome outcome =
      Run("bench noise --scenes scenes --episodes e.json --count 1 --kind slip --out sweep.json "
          "--quiet" +
          std::string(kSmall));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("clearing"), std::string::npos) << outcome.out;
  const Json rows = Json::parse(ReadText(At("sweep.json")))["rows"];
  ASSERT_EQ(rows.size(), 5u);  // none, clearing, and three values
  EXPECT_EQ(rows[0]["kind"], "none");
  EXPECT_EQ(rows[4]["value"], "0.2");
  for (const Json& row : rows) {
    EXPECT_EQ(row["episodes"], 1);
    EXPECT_GT(row["map_error_m"].get<double>(), 0);
  }
}

TEST_F(NoiseCli, AnInterruptedSweepResumes) {
  const std::string sweep =
      "bench noise --scenes scenes --episodes e.json --count 1 --kind slip --out sweep.json "
      "--quiet" +
      std::string(kSmall);
  ASSERT_EQ(Run(sweep).exit_code, 0);
  const std::string whole = ReadText(At("sweep.json"));
  Json cut = Json::parse(whole);
  cut["rows"].erase(4);
  cut["rows"].erase(2);
  cut["rows"][0]["goals"] = 1000;       // a row that is there is taken, not made again
  cut["rows"][1].erase("map_error_m");  // a damaged row is remade
  test::WriteText(At("sweep.json"), cut.dump());
  ASSERT_EQ(Run(sweep).exit_code, 0);
  Json wanted = Json::parse(whole);
  wanted["rows"][0]["goals"] = 1000;
  EXPECT_EQ(Json::parse(ReadText(At("sweep.json"))), wanted);
  ASSERT_EQ(Run(sweep + " --set noise.seed=5").exit_code, 0);  // another task
  EXPECT_NE(Json::parse(ReadText(At("sweep.json")))["rows"][0]["goals"], 1000);
}

TEST_F(NoiseCli, BadInputIsRefused) {
  const std::string sweep = "bench noise --scenes scenes --count 1" + std::string(kSmall);
  ExpectFailure(sweep + " --quiet --episodes none.json", {"none.json"});
  ExpectFailure(sweep + " --quiet --episodes e.json --out e.json/x", {"e.json/x", "--out"});
  EXPECT_EQ(Run(sweep + " --episodes e.json --kind rain").exit_code, 2);
}

TEST_F(NoiseCli, RunsUnderDifferentNoiseAreNotCompared) {
  const std::string eval = std::string("eval --quiet --scenes scenes --episodes e.json") + kSmall +
                           " --set eval.action_budget=5";
  ASSERT_EQ(Run(eval + " --out a").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out b --set noise.profile=realsense").exit_code, 0);
  ExpectFailure("report a b --out other", {"noise.", "--force"});
}

}  // namespace
}  // namespace crossnav
