// SPDX-License-Identifier: MIT
// Frames of real sensors, where they lie beside the project.
#include <gtest/gtest.h>

#include "apps/cli_fixture.h"

namespace crossnav {
namespace {

using SensorsCli = test::Cli;
using test::Json;
using test::Outcome;

TEST_F(SensorsCli, AMapOfRealFramesHoldsInFramesThatWereLeftOut) {
  const std::string data = CROSSNAV_SHARED_DIR "/data";
  if (!std::filesystem::exists(data + "/hololens")) GTEST_SKIP() << "no real frames";
  const Outcome outcome =
      Run("bench sensors " + data + " --quiet --json --set map.clearing=evidence");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json room = Json::parse(outcome.out)["hololens"];
  EXPECT_EQ(room["frames"], 94);
  EXPECT_EQ(room["held_out"], 23);
  EXPECT_LT(room["median_error_m"].get<double>(), 0.1);  // a voxel; half a voxel is required
  EXPECT_LT(room["violated_share"].get<double>(), 0.02);
  EXPECT_EQ(room["floor"]["storeys"], 1);
  EXPECT_LT(room["floor"]["tilt_deg"].get<double>(), 1.0);
  EXPECT_EQ(room["frames_with_stairs_by_geometry"], 0);
  if (room["plants"].is_null()) GTEST_SKIP() << "no networks here";
  ASSERT_EQ(room["known_plants"].size(), 2U);
  for (const Json& plant : room["known_plants"]) EXPECT_LT(plant["error_m"].get<double>(), 0.3);
}

TEST_F(SensorsCli, AFolderWithoutFramesIsNamed) {
  const Outcome outcome = Run("bench sensors scenes");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("hololens"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace crossnav
