// SPDX-License-Identifier: MIT
// Certificates by detection, tracks, and variants that are told something, as a user runs them.
#include <gtest/gtest.h>

#include "apps/cli_fixture.h"

namespace crossnav {
namespace {

using TracksCli = test::Cli;
using test::Json;
using test::kSmall;
using test::ReadText;
using test::WriteText;
namespace fs = std::filesystem;

TEST_F(TracksCli, EpisodesOfEditionTwoAreCheckedByTheirOwnRule) {
  const std::string generate =
      "episodes generate --quiet --json --scenes scenes --count 2 --seed 3 --certify detection "
      "--track drawn --out two.json --set sensor.width_px=160 --set sensor.height_px=160";
  const auto made = Run(generate);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out)["certificate_edition"], 2);
  const std::string check =
      "episodes check two.json --scenes scenes --quiet --set sensor.width_px=160 --set "
      "sensor.height_px=160";
  EXPECT_EQ(Run(check).exit_code, 0);
  Json file = Json::parse(ReadText(At("two.json")));
  EXPECT_EQ(file["episodes"][0]["track"], "drawn");
  for (auto& [key, goals] : file["goals_by_category"].items()) goals[0]["confirmable"] = false;
  WriteText(At("two.json"), file.dump());
  const auto refused = Run(check);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.out.find("confirmed by the detection rule"), std::string::npos) << refused.out;
  file["certificate_edition"] = 3;
  WriteText(At("two.json"), file.dump());
  EXPECT_NE(Run(check).err.find("certificate_edition"), std::string::npos);
}

TEST_F(TracksCli, GapsCompareInformedAndUninformedVariants) {
  const std::string eval =
      std::string("eval --quiet --scenes scenes --episodes e.json --shard 0/4") + kSmall;
  ASSERT_EQ(Run(eval + " --out full").exit_code, 0);
  ASSERT_EQ(Run(eval + " --out told --variant known-objects").exit_code, 0);
  EXPECT_FALSE(fs::is_empty(At("told/known")));
  EXPECT_FALSE(fs::exists(At("full/known")));
  const auto gaps = Run("gaps full told --json");
  ASSERT_EQ(gaps.exit_code, 0) << gaps.err;
  const Json track = Json::parse(gaps.out)["tracks"][0];
  EXPECT_EQ(track["episodes"], 1);
  EXPECT_EQ(track["runs"][1]["variant"], "known-objects");
  EXPECT_EQ(Run("gaps full full").exit_code, 1);
  const auto run = Run(std::string("run --scenes scenes --episodes e.json --episode x --variant "
                                   "known-map --memory a.map") +
                       kSmall);
  EXPECT_EQ(run.exit_code, 1);
}

TEST_F(TracksCli, TheTrackBimIsMadeOfTheUsersBuildings) {
  const auto refused = Run("suite make crossnav-mfmon-2-mini/bim");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--buildings"), std::string::npos) << refused.err;
  const auto made = Run("suite make crossnav-mfmon-2-mini/bim --quiet --json --buildings scenes");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Json document = Json::parse(made.out);
  EXPECT_EQ(document["track"], "bim");
  EXPECT_EQ(document["episodes"], 2);
  const auto none = Run("suite make crossnav-mfmon-2-mini/drawn --homes nowhere.jar");
  EXPECT_NE(none.err.find("sweethome3d"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace crossnav
