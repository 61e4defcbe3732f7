// SPDX-License-Identifier: MIT
// `map build` from the command line: its output, and that errors leave no files behind.
#include <gtest/gtest.h>

#include "apps/cli_fixture.h"
#include "support/places.h"

namespace crossnav {
namespace {

using test::Json;
using test::Outcome;

const std::string kBags = test::SourcePath("tests/recordings/data/");

class MapBuildCli : public test::Cli {
 protected:
  static void SetUpTestSuite() {}  // no house is needed
  static void TearDownTestSuite() {}
  void SetUp() override {}

  /// Exit 1, a message with all parts, and no file except those in `kept`.
  void ExpectRefusal(const std::string& arguments, const std::vector<std::string>& parts,
                     int kept = 0) {
    const Outcome outcome = Run("map build --quiet " + arguments);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    for (const std::string& part : parts)
      EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    std::filesystem::recursive_directory_iterator files(folder_.path());
    EXPECT_EQ(std::distance(begin(files), end(files)), kept);
  }
};

TEST_F(MapBuildCli, ABagBecomesAMapAndEveryImageIsAccountedFor) {
  const Outcome text = Run("map build --from " + kBags + "raw --out a.map");
  ASSERT_EQ(text.exit_code, 0) << text.err;
  for (const char* part : {"ROS 2 bag: 18 of 21 depth images mapped", "1 without a colour image",
                           "1 without a pose", "1 in a jump", "a.map: revision 1", "0 features"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in " << text.out;
  const Outcome json = Run("map build --quiet --json --from " + kBags + "raw/ --out b.map");
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json document = Json::parse(json.out);
  EXPECT_EQ(document["recording"]["frames"], 18);
  EXPECT_EQ(document["recording"]["jumps"], 1);
  EXPECT_GT(document["occupied"], 0);
  const Json info = Json::parse(Run("map info --json a.map").out);
  for (const char* key : {"known", "occupied", "traversable"}) EXPECT_EQ(info[key], document[key]);
  EXPECT_EQ(info["frame"], "ROS 2 bag raw");
  EXPECT_EQ(Json::parse(Run("map info --json b.map").out)["frame"], "ROS 2 bag raw");
}

TEST_F(MapBuildCli, BuildingAgainReplacesTheMap) {
  ASSERT_EQ(Run("map build --from " + kBags + "raw --out a.map").exit_code, 0);
  const Outcome again = Run("map build --json --from " + kBags + "packed --out a.map");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  ASSERT_EQ(Run("map build --from " + kBags + "packed --out b.map").exit_code, 0);
  const Json a = Json::parse(Run("map info --json a.map").out);
  const Json b = Json::parse(Run("map info --json b.map").out);
  EXPECT_EQ(a["revision"], 2);
  EXPECT_EQ(a["known"], b["known"]);
}

TEST_F(MapBuildCli, ErrorsExitWith1AndWriteNothing) {
  ExpectRefusal("--from nowhere --out a.map", {"nowhere", "no such file"});
  ExpectRefusal("--from " + kBags + " --out a.map", {"no recording that is known"});
  ExpectRefusal("--from " + kBags + "raw --out missing/folder/a.map --goal chair --perception none",
                {"--goal", "--perception none"});
  ExpectRefusal("--from " + kBags + "raw --out a.map --intrinsics 0,1,2,3", {"--intrinsics"});
  ExpectRefusal("--from " + kBags + "raw --out a.map --mount 0,0,0,9,9,9,9",
                {"--mount", "unit quaternion"});
  const std::string bytes = test::ReadText(kBags + "raw/raw.mcap");
  test::WriteText(At("torn.mcap"), bytes.substr(0, bytes.size() / 2));
  ExpectRefusal("--from torn.mcap --out a.map", {"torn.mcap", "cut off"}, 1);
  test::WriteText(At("torn.mcap"), "no bag at all");
  ExpectRefusal("--from torn.mcap --out a.map", {"torn.mcap", "not an MCAP"}, 1);
  test::WriteText(At("notes.txt"), "mine");
  ExpectRefusal("--from " + kBags + "raw --out notes.txt", {"notes.txt"}, 2);
  EXPECT_EQ(test::ReadText(At("notes.txt")), "mine");
  EXPECT_EQ(Run("map build --from x").exit_code, 2);
  EXPECT_EQ(Run("map build --from x --out a.map --up x").exit_code, 2);
  EXPECT_EQ(Run("map build --from x --out a.map --intrinsics 1,2").exit_code, 2);
}

TEST_F(MapBuildCli, FiveRealFramesAreMappedAndAnswerAQuestion) {
  const std::string frames = test::SharedPath("data/rgbd");
  if (!std::filesystem::exists(frames)) GTEST_SKIP() << "no real frames beside the project";
  const std::string command = "map build --quiet --json --from '" + frames +
                              "' --intrinsics 518,519,325.5,253.5 --out five.map";
  const Outcome plain = Run(command);
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(Json::parse(plain.out)["recording"]["frames"], 5);
  EXPECT_GT(Json::parse(plain.out)["occupied"], 5000);
  const Outcome doctor = Run(command + " --perception networks --goal sofa --top 2");
  if (doctor.exit_code != 0) GTEST_SKIP() << "no networks here: " << doctor.err;
  const Json document = Json::parse(doctor.out);
  EXPECT_GT(document["feature_rows"], 1000);
  const Json query =
      Json::parse(Run("map query --json five.map sofa --top 2 --set eval.perception=networks").out);
  EXPECT_EQ(document["answer"], query);
}

TEST_F(MapBuildCli, TheFileThatAPresetLacksIsNamedWithItsRemedy) {
  std::filesystem::create_directory(At("nets"));
  for (const char* card : {"crossnav_small.toml", "deimv2_femto_coco.toml"})
    std::filesystem::copy(test::SourcePath("networks/" + std::string(card)), At("nets"));
  const Outcome outcome = RunIn(folder_,
                                "map build --quiet --from " + kBags +
                                    "raw --out a.map --networks real --set networks.dir=nets",
                                "CROSSNAV_NETWORKS= XDG_DATA_HOME=/nowhere");
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* part : {"nets/deimv2_femto_coco.onnx", "CROSSNAV_NETWORKS", "--networks own"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(At("a.map")));
}

TEST_F(MapBuildCli, ADetectorForPhotographsIsTheDefaultWhereItsFileIs) {
  const std::string data = test::SharedPath("data");
  if (!std::filesystem::exists(data + "/models")) GTEST_SKIP() << "no detector beside the project";
  const std::string command = "map build --json --from '" + data +
                              "/rgbd' --intrinsics 518,519,325.5,253.5 --out five.map --goal ";
  const std::string with = "CROSSNAV_NETWORKS='" + data + "/models'";
  const Outcome chairs = RunIn(folder_, command + "chair", with);
  if (chairs.err.find("not available") != std::string::npos) GTEST_SKIP() << chairs.err;
  ASSERT_EQ(chairs.exit_code, 0) << chairs.err;
  EXPECT_NE(chairs.err.find("networks: real (boxes deimv2_femto_coco"), std::string::npos)
      << chairs.err;
  EXPECT_EQ(Json::parse(chairs.out)["detected"]["detector"], "deimv2_femto_coco");
  EXPECT_EQ(Json::parse(chairs.out)["detected"]["is_class"], true);
  EXPECT_EQ(Json::parse(chairs.out)["verdict_by"], "detector");
  EXPECT_EQ(Json::parse(chairs.out)["verdict"],
            Json::parse(chairs.out)["detected"]["places"].empty() ? "absent" : "present");
  const Outcome own = RunIn(folder_, command + "wall --networks own", with);
  ASSERT_EQ(own.exit_code, 0) << own.err;
  EXPECT_NE(own.err.find("networks: own"), std::string::npos) << own.err;
  EXPECT_EQ(Json::parse(own.out)["detected"]["is_class"], false);
  EXPECT_TRUE(Json::parse(own.out)["answer"]["present_from"].is_number()) << "of the card";
  EXPECT_EQ(Json::parse(own.out)["verdict_by"], "memory");
}

}  // namespace
}  // namespace crossnav
