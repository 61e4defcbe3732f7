// SPDX-License-Identifier: MIT
// Questions about a saved map, and described goals, on the command line.
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/cli_fixture.h"

namespace crossnav {
namespace {

using test::Cli;
using test::Json;
using test::kSmall;
using test::Outcome;

class AskCli : public Cli {
 protected:
  Json Asked(const std::string& question) {
    const Outcome outcome = Run("ask --json m.map \"" + question + "\"");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json();
  }
};

TEST_F(AskCli, AnswersSayWhatIsKnownAndWhatIsNot) {
  ASSERT_EQ(Run("run --quiet --json --scenes scenes --episodes e.json --episode " + FirstId() +
                kSmall + " --save-map m.map --set eval.action_budget=60")
                .exit_code,
            0);
  const Json floors = Asked("how many floors are there?");
  EXPECT_GE(floors["count"], 1);
  const Json sofa = Asked("where did I last see a sofa?");
  EXPECT_EQ(sofa["kind"], "where");
  for (const Json& thing : sofa["things"]) EXPECT_EQ(thing["category"], "sofa");
  const Json rooms = Asked("which rooms have no toilet");
  EXPECT_EQ(rooms["known"], rooms["not_looked_at"].empty());
  const Outcome wrong = Run("ask m.map \"why is there a sofa\"");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("where is"), std::string::npos) << wrong.err;
  EXPECT_EQ(Run("ask m.map \"where is the sofa\" --ground-floor 9").exit_code, 1);
  EXPECT_EQ(Run("ask m.map").exit_code, 2);
}

TEST_F(AskCli, DescribedGoalsAreOfOneObjectEach) {
  ASSERT_EQ(Run("episodes generate --scenes scenes --count 4 --seed 3 --out d.json "
                "--goals-as description")
                .exit_code,
            0);
  const Json file = Json::parse(test::ReadText(At("d.json")));
  int described = 0;
  for (const auto& [key, goals] : file["goals_by_category"].items())
    if (key.find("_the ") != std::string::npos) {
      ++described;
      EXPECT_EQ(goals.size(), 1u) << key;
    }
  EXPECT_GT(described, 0);
}

TEST_F(AskCli, GoalsOfThreeKindsArePlayedAndReportedByKind) {
  ASSERT_EQ(Run("episodes generate --scenes scenes --count 4 --goals 2 --seed 3 --out p.json "
                "--goals-as picture")
                .exit_code,
            0);
  Json file = Json::parse(test::ReadText(At("p.json")));
  ASSERT_FALSE(file["goal_pictures"].empty());
  const std::string name = file["goal_pictures"].begin().key();
  int objects = 0;
  for (const auto& [key, goals] : file["goals_by_category"].items())
    if (key.ends_with("_" + name)) objects += static_cast<int>(goals.size());
  EXPECT_EQ(objects, 1);
  const auto eval = Run("eval --scenes scenes --episodes p.json --out run --quiet --json" +
                        std::string(kSmall) + " --set eval.action_budget=20");
  ASSERT_EQ(eval.exit_code, 0) << eval.err;
  const Outcome metrics = Run("metrics run/results.jsonl --json");
  ASSERT_EQ(metrics.exit_code, 0) << metrics.err;
  EXPECT_GE(Json::parse(metrics.out)["kinds"]["picture"]["executed"], 1);

  file["goal_pictures"][name]["png"] = "AAAA";
  test::WriteText(At("bad.json"), file.dump());
  const Outcome bad = Run("eval --scenes scenes --episodes bad.json --out bad");
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.err.find(name), std::string::npos) << bad.err;
  EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
}

}  // namespace
}  // namespace crossnav
