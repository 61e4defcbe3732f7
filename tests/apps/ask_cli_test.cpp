// SPDX-License-Identifier: MIT
// Questions about a saved map, and described goals, on the command line.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace crossnav
