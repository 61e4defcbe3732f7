// SPDX-License-Identifier: MIT
// Chooses scenes, lists them, and draws episodes in the listed scenes.
#include "cli_fixture.h"

namespace crossnav::test {
namespace {

class ChooseCli : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    fs::copy(At("scenes/00001-CrossnavHouse"), At("scenes/00002-CrossnavHouse2"));
    for (const char* ending : {".glb", ".semantic.glb", ".semantic.txt"}) {
      const std::string folder = "scenes/00002-CrossnavHouse2/CrossnavHouse";
      fs::rename(At(folder + ending), At(folder + "2" + ending));
    }
  }
};

TEST_F(ChooseCli, ScenesAreChosenByFloorsAndCategories) {
  const Outcome outcome =
      Run("scene choose --json --scenes scenes --floors 2 --categories bed,sofa "
          "--out list.txt" +
          std::string(kSmall));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_EQ(document["chosen"], 2);
  EXPECT_EQ(document["scenes"][0]["floors"], 2);
  EXPECT_EQ(ReadText(At("list.txt")), "00001-CrossnavHouse\n00002-CrossnavHouse2\n");
  const Outcome none = Run("scene choose --json --scenes scenes --floors 3" + std::string(kSmall));
  EXPECT_EQ(Json::parse(none.out)["chosen"], 0);
  ExpectFailure("scene choose --scenes scenes --categories oven", {"oven", "no category"});
}

TEST_F(ChooseCli, EpisodesAreDrawnInTheListedScenesWithTheWantedCounts) {
  WriteText(At("list.txt"), "# the second by its name\nCrossnavHouse2  # without its number\n");
  for (const std::string& option : {std::string(), std::string(" --by-scene")}) {
    const Outcome outcome =
        Run("episodes generate --json --scenes scenes --scene-list list.txt --count 6 --first 2,0,1"
            " --seed 3 --out drawn.json" +
            option + kSmall);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Json document = Json::parse(outcome.out);
    EXPECT_EQ(document["scenes"], 1);
    EXPECT_EQ(document["first_transition_stage"], Json({2, 0, 1}));
    EXPECT_NE(outcome.err.find("peak memory "), std::string::npos) << outcome.err;
    const Json file = Json::parse(ReadText(At("drawn.json")));
    EXPECT_EQ(file["episodes"].size(), 6u);
    for (const Json& episode : file["episodes"]) {
      EXPECT_EQ(episode["scene_id"], "00002-CrossnavHouse2/CrossnavHouse2.glb");
    }
    EXPECT_EQ(Run("episodes check drawn.json --scenes scenes" + std::string(kSmall)).exit_code, 0);
  }
}

TEST_F(ChooseCli, BadListsAndCountsAreNamed) {
  const std::string generate = "episodes generate --scenes scenes --count 2 --out drawn.json ";
  WriteText(At("list.txt"), "CrossnavHouse\nnowhere\n");
  ExpectFailure(generate + "--scene-list list.txt", {"list.txt, line 2", "nowhere"});
  WriteText(At("list.txt"), "CrossnavHouse\n00001-CrossnavHouse\n");
  ExpectFailure(generate + "--scene-list list.txt", {"line 2", "listed twice"});
  WriteText(At("list.txt"), "# nothing\n");
  ExpectFailure(generate + "--scene-list list.txt", {"list.txt", "lists no scene"});
  ExpectFailure(generate + "--first 2,1", {"--first", "--count"});
  ExpectFailure(generate + "--first 0,0,0,1", {"--first", "goals"});
}

}  // namespace
}  // namespace crossnav::test
