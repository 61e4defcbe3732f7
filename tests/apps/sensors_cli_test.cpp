// SPDX-License-Identifier: MIT
// Frames of real sensors, where they lie beside the project.
#include <gtest/gtest.h>

#include "apps/cli_fixture.h"
#include "inference/model_files.h"
#include "support/places.h"

namespace crossnav {
namespace {

using SensorsCli = test::Cli;
using test::Json;
using test::Outcome;

class RealFrames : public SensorsCli {
 protected:
  /// Result of `bench sensors` on the real frames; null without these frames.
  Json Trials(const std::string& options = "") {
    const std::string data = test::SharedPath("data");
    if (!std::filesystem::exists(data + "/hololens")) return nullptr;
    const Outcome outcome =
        Run("bench sensors " + data + " --quiet --json --set map.clearing=evidence" + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(RealFrames, AMapOfRealFramesHoldsInFramesThatWereLeftOut) {
  const Json trials = Trials();
  if (trials.is_null()) GTEST_SKIP() << "no real frames: " << test::SharedPath("data/hololens");
  const Json& room = trials["hololens"];
  EXPECT_EQ(room["frames"], 94);
  EXPECT_EQ(room["held_out"], 23);
  EXPECT_LE(room["median_error_m"].get<double>(), 0.05);  // half a voxel
  EXPECT_LT(room["violated_share"].get<double>(), 0.02);
  EXPECT_EQ(room["floor"]["storeys"], 1);
  EXPECT_LT(room["floor"]["tilt_deg"].get<double>(), 1.0);
  EXPECT_EQ(room["frames_with_stairs_by_geometry"], 0);
  EXPECT_EQ(trials["rgbd"]["frames_with_stairs_by_geometry"], 0);
  ASSERT_EQ(trials["stairs"].size(), 2U);
  const int treads[] = {3, 5};  // counted in the colour and depth pictures
  for (int k = 0; k < 2; ++k)
    for (const Json& flight : {trials["stairs"][k], trials["stairs"][k]["on_carpet"]}) {
      EXPECT_EQ(flight["treads"], treads[k]) << k;
      EXPECT_NEAR(flight["riser_m"].get<double>(), 0.101, 0.15 * 0.101) << k;
      EXPECT_NEAR(flight["tread_m"].get<double>(), 0.285, 0.15 * 0.285) << k;
    }
}

TEST_F(RealFrames, OurNetworkFindsTheBigPlantAndTheTreadsThatItSees) {
  if (!inference::test::HasBackend()) GTEST_SKIP() << "no inference library here";
  const Json trials = Trials(" --perception networks --networks own");
  if (trials.is_null()) GTEST_SKIP() << "no real frames: " << test::SharedPath("data/hololens");
  const Json& plants = trials["hololens"]["known_plants"];
  ASSERT_EQ(plants.size(), 2U);
  for (const Json& plant : plants) EXPECT_LT(plant["error_m"].get<double>(), 0.3) << plant;
  EXPECT_EQ(trials["stairs"][1]["with_mask"]["treads"], 5);
}

TEST_F(RealFrames, ARobotFindsItselfInAMapOfOtherFrames) {
  const std::string data = test::SharedPath("data/hololens");
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real frames: " << data;
  const Outcome outcome =
      Run("bench localize --recording " + data + " --quiet --json --set map.clearing=evidence");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json result = Json::parse(outcome.out, nullptr, false);
  EXPECT_EQ(result["trials"], 63);
  EXPECT_GE(result["right"]["count"].get<int>(), 57);
  EXPECT_LE(result["wrong"]["count"].get<int>(), 4);  // single views decide here, too
}

TEST_F(SensorsCli, OneSourceOfLostRobotsIsNeeded) {
  EXPECT_EQ(Run("bench localize").exit_code, 1);
  EXPECT_EQ(Run("bench localize --scenes scenes --recording scenes").exit_code, 1);
}

TEST_F(SensorsCli, AFolderWithoutFramesIsNamed) {
  const Outcome outcome = Run("bench sensors scenes");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("hololens"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace crossnav
